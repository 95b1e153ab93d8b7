#include "harness/files/file_group.hpp"

namespace qsmpc::harness {

PendingFile& FileGroup::add(const std::string& path) {
  return *files_.emplace_back(std::make_unique<PendingFile>(path));
}

void FileGroup::commit() {
  for (const std::unique_ptr<PendingFile>& file : files_) file->commit();
}

void FileGroup::commit_sealed() {
  remove_file(files_.back()->path());
  commit();
}

std::vector<std::string> FileGroup::paths() const {
  std::vector<std::string> paths;
  paths.reserve(files_.size());
  for (const std::unique_ptr<PendingFile>& file : files_) paths.push_back(file->path());
  return paths;
}

}  // namespace qsmpc::harness
