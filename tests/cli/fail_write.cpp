// Loaded into the command (LD_PRELOAD), fails its N-th write, as a full disc would: SINEW_FAIL_AT says which,
// and SINEW_FAIL_ERRNO with what. Opening for writing, bringing to the disc, cutting and renaming count as
// well. Says on stderr when it has.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> calls{0};

/// The command alone, none of the programs it starts.
bool is_meant() {
  static const bool meant = [] {
    char path[4096] = {};
    const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path - 1);
    const char* name = size > 0 ? std::strrchr(path, '/') : nullptr;
    return name && std::strcmp(name, "/sinew") == 0 && std::getenv("SINEW_FAIL_AT");
  }();
  return meant;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// Whether this is the call that fails; errno then says why.
bool fails(const char* what) {
  if (!is_meant() || ++calls != std::atol(std::getenv("SINEW_FAIL_AT"))) return false;
  static const auto real = next<ssize_t (*)(int, const void*, std::size_t)>("write");
  for (const char* part : {"failed: ", what, "\n"})
    if (real(2, part, std::strlen(part)) < 0) break;
  const char* reason = std::getenv("SINEW_FAIL_ERRNO");
  errno = reason ? std::atoi(reason) : ENOSPC;
  return true;
}

/// Files of a disc; stderr has to tell, and what lies in memory is on none.
bool is_on_disc(int file) {
  struct stat status = {};
  if (file == 2 || ::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return false;
  return status.st_nlink > 0;  // a file of memory has no name
}

bool writes(int flags) { return (flags & O_ACCMODE) != O_RDONLY; }

}  // namespace

extern "C" {

#define SINEW_OPEN(name)                                                                  \
  int name(const char* path, int flags, ...) {                                            \
    va_list rest;                                                                         \
    va_start(rest, flags);                                                                \
    const unsigned mode = (flags & O_CREAT) ? va_arg(rest, unsigned) : 0U;                \
    va_end(rest);                                                                         \
    if (writes(flags) && std::strncmp(path, "/dev/", 5) != 0 && fails("open")) return -1; \
    return next<int (*)(const char*, int, ...)>(#name)(path, flags, mode);                \
  }
SINEW_OPEN(open)
SINEW_OPEN(open64)
#undef SINEW_OPEN

ssize_t write(int file, const void* bytes, std::size_t size) {
  if (is_on_disc(file) && fails("write")) return -1;
  return next<ssize_t (*)(int, const void*, std::size_t)>("write")(file, bytes, size);
}

ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t at) {
  if (is_on_disc(file) && fails("pwrite")) return -1;
  return next<ssize_t (*)(int, const void*, std::size_t, off_t)>("pwrite")(file, bytes, size, at);
}

ssize_t pwrite64(int file, const void* bytes, std::size_t size, off64_t at) {
  if (is_on_disc(file) && fails("pwrite")) return -1;
  return next<ssize_t (*)(int, const void*, std::size_t, off64_t)>("pwrite64")(file, bytes, size, at);
}

int ftruncate(int file, off_t size) noexcept {
  if (is_on_disc(file) && fails("ftruncate")) return -1;
  return next<int (*)(int, off_t)>("ftruncate")(file, size);
}

int ftruncate64(int file, off64_t size) noexcept {
  if (is_on_disc(file) && fails("ftruncate")) return -1;
  return next<int (*)(int, off64_t)>("ftruncate64")(file, size);
}

int fsync(int file) {
  if (is_on_disc(file) && fails("fsync")) return -1;
  return next<int (*)(int)>("fsync")(file);
}

int fdatasync(int file) {
  if (is_on_disc(file) && fails("fdatasync")) return -1;
  return next<int (*)(int)>("fdatasync")(file);
}

int rename(const char* from, const char* to) noexcept {
  if (fails("rename")) return -1;
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  if (fails("renameat2")) return -1;
  return next<int (*)(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from,
                                                                                  to_folder, to, flags);
}
}
