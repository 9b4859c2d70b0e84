#include "plan/mesh_file.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "io/document/visible.hpp"
#include "sinew/plan/scene.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::chrono::seconds longest{30};
constexpr rlim_t more_memory = rlim_t{6} << 30;                            // [byte]
constexpr char has_triangles = 'T', is_too_large = 'L', has_failed = 'E';  // first byte of an answer

/// Without the end of a header assimp's reader does not end either.
bool has_ply_header(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 10'000> line{};
  for (int k = 0; k < 1000 && file.getline(line.data(), line.size()); ++k) {  // fails at a longer line
    std::string_view text = line.data();
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (k == 0 && text != "ply") return false;
    if (text == "end_header") return true;
  }
  return false;
}

/// Sanitizers take more addresses than any limit.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#elif defined(__has_feature)
constexpr bool is_sanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer);
#else
constexpr bool is_sanitized = false;
#endif

std::string read_by_assimp(const std::filesystem::path& path) {
  Assimp::Importer importer;
  // faces of more than three corners; nothing else: what is degenerate is to be seen, not repaired
  const aiScene* read =
      importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (read == nullptr) return has_failed + visible_line(importer.GetErrorString());
  std::size_t count = 0;
  for (unsigned m = 0; m < read->mNumMeshes; ++m) count += read->mMeshes[m]->mNumFaces;
  if (count > triangle_limit)
    return is_too_large + fmt::format("{} triangles; at most {}", count, triangle_limit);
  std::string bytes(1, has_triangles);
  for (unsigned m = 0; m < read->mNumMeshes; ++m) {
    const aiMesh& part = *read->mMeshes[m];
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // a point or a line bounds nothing
      for (unsigned i = 0; i < 3; ++i) {
        if (face.mIndices[i] >= part.mNumVertices)
          return has_failed + std::string("a triangle has a corner that there is not");
        const aiVector3D& v = part.mVertices[face.mIndices[i]];
        const float corner[] = {v.x, v.y, v.z};
        bytes.append(reinterpret_cast<const char*>(corner), sizeof corner);
      }
    }
  }
  const std::uint64_t size = bytes.size() - 1;
  bytes.insert(1, reinterpret_cast<const char*>(&size), sizeof size);
  return bytes;
}

/// The triangles of an answer, if it is whole.
std::optional<std::vector<float>> triangles_of(const std::string& bytes) {
  std::uint64_t size = 0;
  constexpr std::size_t head = 1 + sizeof size;
  if (bytes.size() < head) return {};
  std::memcpy(&size, bytes.data() + 1, sizeof size);
  if (bytes.size() - head != size) return {};
  std::vector<float> corners(size / sizeof(float));
  if (size > 0) std::memcpy(corners.data(), bytes.data() + head, size);
  return corners;
}

/// The other process: never returns.
[[noreturn]] void answer(const std::filesystem::path& path, int to) {
  rlim_t addresses = 0;  // that the program has already
  if (std::ifstream now("/proc/self/statm"); now >> addresses)
    addresses *= static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  const rlimit no_core{0, 0},
      time{static_cast<rlim_t>(longest.count()), static_cast<rlim_t>(longest.count())},
      memory{addresses + more_memory, addresses + more_memory};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &time);
  if (!is_sanitized) setrlimit(RLIMIT_AS, &memory);
  if (const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC); nothing >= 0)
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);  // assimp's complaints
  signal(SIGPIPE, SIG_DFL);
  signal(SIGABRT, SIG_DFL);
  signal(SIGSEGV, SIG_DFL);
  std::string bytes;
  try {
    bytes = read_by_assimp(path);
  } catch (const std::bad_alloc&) {
    bytes = has_failed + std::string("there is not enough memory to read it");
  } catch (const std::exception& error) {
    bytes = has_failed + visible_line(error.what());
  }
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t written = write(to, bytes.data() + sent, bytes.size() - sent);
    if (written < 0 && errno != EINTR) break;
    if (written > 0) sent += static_cast<std::size_t>(written);
  }
  _exit(0);
}

/// All that comes, until the other end is closed or time is over.
std::string received(int from) {
  const auto end = std::chrono::steady_clock::now() + longest;
  std::string bytes;
  char buffer[1 << 16];
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd ready{from, POLLIN, 0};
    const int polled = poll(&ready, 1, static_cast<int>(std::max<long>(left.count(), 0)));
    if (polled < 0 && errno == EINTR) continue;
    if (polled <= 0) return bytes;
    const ssize_t count = read(from, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(count));
  }
}

}  // namespace

Expected<std::vector<float>> read_triangles(const std::filesystem::path& path) {
  std::string format = path.extension().string();
  for (char& c : format)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  // of the forty formats that assimp knows
  if (format != ".stl" && format != ".obj" && format != ".ply")
    return failure("file_unreadable", path.string(), "a mesh is an .stl, .obj or .ply file");
  if (format == ".ply" && !has_ply_header(path))
    return failure("file_unreadable", path.string(), "it has no PLY header that ends by end_header");
  // A child of another thread would hold this pipe open as long as it lives.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return failure("file_unreadable", path.string(),
                   fmt::format("no pipe to its reader: {}", std::strerror(errno)));
  const pid_t reader = fork();
  if (reader == 0) answer(path, ends[1]);
  close(ends[1]);
  std::string bytes;
  if (reader > 0) {
    bytes = received(ends[0]);
    kill(reader, SIGKILL);  // where it has not ended by itself
    while (waitpid(reader, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  close(ends[0]);
  if (reader < 0)
    return failure("file_unreadable", path.string(),
                   fmt::format("its reader cannot be started: {}", std::strerror(errno)));
  if (bytes.starts_with(is_too_large)) return failure("mesh_too_large", path.string(), bytes.substr(1));
  if (bytes.starts_with(has_failed))
    return failure("file_unreadable", path.string(),
                   bytes.size() > 1 ? bytes.substr(1) : "assimp cannot read it");
  if (bytes.starts_with(has_triangles))
    if (auto corners = triangles_of(bytes)) return std::move(*corners);
  return failure("file_unreadable", path.string(),
                 "assimp, which reads it, died of it or did not end: it is damaged, or too large");
}

}  // namespace sinew::inline v1
