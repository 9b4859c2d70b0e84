#include "writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <string_view>
#include <utility>

namespace sinew::server::device {
namespace {

/// What was wrong, empty: nothing.
std::string write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::strerror(count < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return {};
}

/// A file that only grows, by whole pieces.
class GrowingFile {
 public:
  GrowingFile() = default;
  ~GrowingFile() { close(); }
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  std::string open(const std::filesystem::path& path, std::string_view head) {
    close();
    std::error_code why;
    std::filesystem::create_directories(path.parent_path(), why);
    if (why) return fmt::format("{}: {}", path.parent_path().string(), why.message());
    file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file_ < 0) return fmt::format("{}: {}", path.string(), std::strerror(errno));
    struct stat status {};
    if (::fstat(file_, &status) == 0 && status.st_size > 0) {
      close();
      return fmt::format("{}: there is a recording of this name already", path.string());
    }
    size_ = 0;
    return append(head);
  }
  /// All of it, or nothing: half a line would be a damaged one.
  std::string append(std::string_view bytes) {
    if (file_ < 0) return {};
    const std::string error = write_all(file_, bytes);
    if (error.empty())
      size_ += static_cast<off_t>(bytes.size());
    else [[maybe_unused]]
      const int ignored = ::ftruncate(file_, size_);  // a pipe has no size
    return error;
  }
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

 private:
  int file_ = -1;
  off_t size_ = 0;
};

std::string write_file(const std::filesystem::path& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0) return fmt::format("{}: {}", path.string(), std::strerror(errno));
  const std::string error = write_all(file, bytes);
  ::close(file);
  if (!error.empty()) ::unlink(path.c_str());
  return error;
}

}  // namespace

struct FileWriter::State {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Job> jobs;
  std::size_t bytes = 0;
  bool is_working = false, is_over = false, has_ended = false;
  long number = 0;  ///< of the file that was opened last
  News news;

  void run() {
    sigset_t of_writing;
    sigemptyset(&of_writing);
    sigaddset(&of_writing, SIGPIPE);
    sigaddset(&of_writing, SIGXFSZ);                   // a limit of file sizes (ulimit -f)
    pthread_sigmask(SIG_BLOCK, &of_writing, nullptr);  // they are errors like others
    GrowingFile file;
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [&] { return is_over || !jobs.empty(); });
      if (jobs.empty()) break;
      const Job job = std::move(jobs.front());
      jobs.pop_front();
      is_working = true;
      const bool is_broken = !news.error.empty() && job.kind != Job::Kind::open;
      lock.unlock();
      const std::string error = is_broken ? "" : work(file, job);
      lock.lock();
      is_working = false;
      bytes -= job.bytes.size();
      if (job.kind == Job::Kind::open) {
        number = job.number;
        news = {error.empty(), error};
      } else if (!error.empty()) {
        news.error = error;
      }
      changed.notify_all();
    }
    has_ended = true;
    changed.notify_all();
  }
  static std::string work(GrowingFile& file, const Job& job) {
    switch (job.kind) {
      case Job::Kind::open:
        return file.open(job.path, job.bytes);
      case Job::Kind::append:
        return file.append(job.bytes);
      case Job::Kind::whole:
        return write_file(job.path, job.bytes);
      case Job::Kind::close:
        file.close();
    }
    return {};
  }
};

bool FileWriter::put(Job job) {
  if (!state_) {
    state_ = std::make_shared<State>();
    thread_ = std::thread([state = state_] { state->run(); });
  }
  const std::lock_guard lock(state_->mutex);
  const bool is_full = state_->jobs.size() >= max_jobs || state_->bytes + job.bytes.size() > max_bytes;
  if (is_full && job.kind != Job::Kind::close) return false;
  state_->bytes += job.bytes.size();
  state_->jobs.push_back(std::move(job));
  state_->changed.notify_all();
  return true;
}

bool FileWriter::open(std::filesystem::path path, std::string head, long number) {
  return put({Job::Kind::open, std::move(path), std::move(head), number});
}
bool FileWriter::append(std::string bytes) { return put({Job::Kind::append, {}, std::move(bytes)}); }
bool FileWriter::write_whole(std::filesystem::path path, std::string bytes) {
  return put({Job::Kind::whole, std::move(path), std::move(bytes)});
}
void FileWriter::close() {
  if (state_) put({Job::Kind::close});
}

FileWriter::News FileWriter::news(long number) const {
  if (!state_) return {};
  const std::lock_guard lock(state_->mutex);
  return number == state_->number ? state_->news : News();
}

bool FileWriter::wait(std::chrono::milliseconds patience) {
  if (!state_) return true;
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, patience,
                                  [&] { return state_->jobs.empty() && !state_->is_working; });
}

FileWriter::~FileWriter() {
  if (!state_) return;
  {
    std::unique_lock lock(state_->mutex);
    state_->is_over = true;
    state_->changed.notify_all();
    state_->changed.wait_for(lock, std::chrono::seconds(1), [&] { return state_->has_ended; });
    if (!state_->has_ended) {
      thread_.detach();
      return;
    }
  }
  thread_.join();
}

}  // namespace sinew::server::device
