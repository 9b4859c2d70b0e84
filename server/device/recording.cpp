#include "recording.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace sinew::server::device {

std::string GrowingFile::open(const std::filesystem::path& path) {
  close();
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  return is_open() ? "" : fmt::format("{}: {}", path.string(), std::strerror(errno));
}

std::string GrowingFile::append(std::string_view line) {
  while (!line.empty()) {
    const ssize_t count = ::write(file_, line.data(), line.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::strerror(count < 0 ? errno : ENOSPC);
    line.remove_prefix(static_cast<std::size_t>(count));
  }
  return {};
}

void GrowingFile::close() {
  if (is_open()) ::close(file_);
  file_ = -1;
}

std::string Recording::begin(const std::string& name, const std::string& header) {
  end();
  std::error_code why;
  std::filesystem::create_directories(folder_, why);
  if (why) return error_ = fmt::format("{}: {}", folder_.string(), why.message());
  name_ = name;
  count_ = 0;
  error_ = rows_.open(folder_ / (name + ".csv"));
  if (error_.empty()) error_ = events_.open(folder_ / (name + "-events.csv"));
  if (error_.empty()) error_ = rows_.append(header + '\n');
  if (error_.empty()) error_ = events_.append("time[s],clock,kind,text\n");
  if (!error_.empty()) end();
  return error_;
}

void Recording::row(const std::string& line) {
  if (!is_on() || !error_.empty()) return;
  error_ = rows_.append(line + '\n');
  if (error_.empty()) ++count_;
}

void Recording::event(std::string_view line) {
  if (!is_on() || !error_.empty()) return;
  error_ = events_.append(std::string(line) + '\n');
}

void Recording::end() {
  rows_.close();
  events_.close();
}

}  // namespace sinew::server::device
