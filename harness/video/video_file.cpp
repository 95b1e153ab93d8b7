#include "harness/video/video_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <unistd.h>

#include "harness/files/atomic_file.hpp"
#include "harness/files/random_access_file.hpp"

namespace qsmpc::harness {

/// A file that is created by clear().
class VideoFile::Bytes final : public render::ByteFile {
 public:
  explicit Bytes(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const { return path_; }

  void clear() override { file_.emplace(path_); }
  std::int64_t size() override { return file_.value().size(); }
  void write_at(std::int64_t position, std::span<const std::uint8_t> bytes) override {
    file_.value().write_at(position, bytes);
  }
  std::size_t read_at(std::int64_t position, std::span<std::uint8_t> out) override {
    return file_.value().read_at(position, out);
  }

 private:
  std::string path_;
  std::optional<RandomAccessFile> file_;
};

VideoFile::VideoFile(std::string path, render::VideoSettings settings)
    : path_(std::move(path)), partial_(std::make_unique<Bytes>(path_ + ".partial")) {
  settings.name = path_;
  writer_ = std::make_unique<render::VideoWriter>(*partial_, settings);
}

VideoFile::~VideoFile() = default;

void VideoFile::add(const render::Image& image) { writer_->add(image); }

void VideoFile::finish() {
  Bytes aside(path_ + ".finished.partial");
  try {
    writer_->finish(aside);
    commit_file(aside.path(), path_);
  } catch (...) {
    ::unlink(aside.path().c_str());
    throw;
  }
  remove_file(partial_->path());
}

}  // namespace qsmpc::harness
