// Storage that is written again and again with about as much.
#pragma once

#include <cstddef>
#include <vector>

namespace qsmpc {

/// Makes room for `count` entries. Where there is too little, for twice as many, so that
/// counts which vary from use to use soon cause no more allocations.
template <class T>
void make_room(std::vector<T>& entries, std::size_t count) {
  if (entries.capacity() < count) entries.reserve(2 * count);
}

}  // namespace qsmpc
