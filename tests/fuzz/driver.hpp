/// @file driver.hpp
/// What libFuzzer does, in small, for compilers that lack it: the corpus, then mutations of it from a seed,
/// for SINEW_FUZZ_SECONDS. A target defines `LLVMFuzzerTestOneInput`, and may define
/// `LLVMFuzzerCustomMutator`, as for libFuzzer, which takes the place of this file with -D SINEW_FUZZER=ON
/// and clang.
///
///     fuzz_session FOLDER|FILE...        environment: SINEW_FUZZ_SECONDS, SINEW_FUZZ_SEED
///
/// The inputs run in a child process; the one it died of, or took too long for, is written to a file here.
/// Exit code 1 then.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace sinew::fuzz {

using Random = std::mt19937_64;

inline std::size_t below(Random& random, std::size_t end) { return end == 0 ? 0 : random() % end; }

/// Numbers on which programs break.
inline constexpr std::string_view odd_numbers[] = {"0",           "-0.0",       "1",
                                                   "-1",          "2",          "3",
                                                   "0.5",         "1e-9",       "1e-320",
                                                   "1e-300",      "1e9",        "-1e9",
                                                   "1e16",        "1e300",      "-1e300",
                                                   "1e308",       "2147483647", "2147483648",
                                                   "-2147483649", "4294967296", "9223372036854775808",
                                                   "1e999",       "0.1",        "100000",
                                                   "1e6",         "-1e-12",     "3.141592653589793",
                                                   "45"};

/// Edits of a text: spans, lines, numbers, pieces of `words` and of `other`.
inline std::string mutated(std::string text, const std::string& other,
                           std::span<const std::string_view> words, Random& random) {
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  for (std::size_t edits = 1 + below(random, 4); edits > 0; --edits) {
    const std::size_t at = below(random, text.size() + 1),
                      length = std::min(below(random, 24), text.size() - at);
    const std::size_t line = text.rfind('\n', at == 0 ? 0 : at - 1) + 1,
                      end = std::min(text.find('\n', at), text.size());
    switch (below(random, 9)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        if (!words.empty()) text.insert(at, words[below(random, words.size())]);
        break;
      case 2:
        text.insert(below(random, text.size() + 1), text.substr(at, length));
        break;
      case 3:
        if (at < text.size()) text[at] = static_cast<char>(random());
        break;
      case 4:  // a line less, or twice
        if (line < end)
          random() % 2 ? text.erase(line, end - line + 1)
                       : text.insert(line, text.substr(line, end - line) + '\n');
        break;
      case 5: {
        const std::size_t from = below(random, other.size() + 1);
        text.insert(at, other.substr(from, below(random, 60)));
        break;
      }
      default: {  // the next number becomes another one
        std::size_t first = at;
        while (first < text.size() && !is_digit(text[first])) ++first;
        std::size_t last = first;
        while (last < text.size() && is_digit(text[last])) ++last;
        if (first < last)
          text.replace(first, last - first, odd_numbers[below(random, std::size(odd_numbers))]);
      }
    }
  }
  return text;
}

}  // namespace sinew::fuzz

#ifndef SINEW_LIBFUZZER
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

/// @param seed of the mutation; the answer is the new size
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t most, unsigned int seed);

namespace sinew::fuzz {

constexpr std::size_t largest_input = std::size_t{1} << 16U;
/// Of processor time, so that a loaded machine is no hang. Instrumented code is slow.
#ifdef SINEW_SANITIZED
constexpr double seconds_an_input = 40;
#else
constexpr double seconds_an_input = 2;
#endif

/// What the child is at, seen by its parent.
struct Shared {
  std::size_t runs, size;
  bool is_slow;
  std::uint8_t input[largest_input];
};

inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

inline std::vector<std::string> read_corpus(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < argc; ++i) {
    if (!std::filesystem::is_directory(argv[i]))
      files.emplace_back(argv[i]);
    else
      for (const auto& entry : std::filesystem::directory_iterator(argv[i]))
        if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<std::string> corpus;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    if (corpus.back().size() > largest_input) corpus.back().resize(largest_input);
  }
  return corpus;
}

inline void run_one(std::string_view input, Shared& shared) {
  std::memcpy(shared.input, input.data(), input.size());
  shared.size = input.size();
  const double begin = processor_seconds();
  LLVMFuzzerTestOneInput(shared.input, shared.size);
  ++shared.runs;
  if (processor_seconds() - begin < seconds_an_input) return;
  shared.is_slow = true;
  std::_Exit(1);
}

inline std::string next_input(const std::vector<std::string>& corpus, std::span<const std::string_view> words,
                              Random& random) {
  std::string text = corpus[below(random, corpus.size())];
  const std::size_t kind = below(random, 4);
  if (LLVMFuzzerCustomMutator && kind != 0) {
    std::vector<std::uint8_t> data(largest_input);
    std::memcpy(data.data(), text.data(), text.size());
    std::size_t size = text.size();
    for (std::size_t times = 1 + below(random, 3); times > 0; --times)
      size = LLVMFuzzerCustomMutator(data.data(), size, data.size(), static_cast<unsigned>(random()));
    text.assign(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(size));
    if (kind != 1) return text;
  }
  text = mutated(std::move(text), corpus[below(random, corpus.size())], words, random);
  text.resize(std::min(text.size(), largest_input));
  return text;
}

/// @param name of the target, for messages and files
inline int fuzz(int argc, char** argv, const char* name, std::span<const std::string_view> words) {
  using Clock = std::chrono::steady_clock;
  const char *seconds_text = std::getenv("SINEW_FUZZ_SECONDS"), *seed_text = std::getenv("SINEW_FUZZ_SEED");
  const double seconds = seconds_text ? std::atof(seconds_text) : SINEW_FUZZ_SECONDS;
  const std::uint64_t seed = seed_text ? std::strtoull(seed_text, nullptr, 10) : 20240607;
  const std::vector<std::string> corpus = read_corpus(argc, argv);
  if (corpus.empty()) return std::fprintf(stderr, "fuzz_%s: no corpus; name its folder\n", name), 1;
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 1;
  auto& shared = *static_cast<Shared*>(memory);
  const auto begin = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const pid_t child = fork();
  if (child == 0) {
    for (const std::string& input : corpus) run_one(input, shared);
    for (Random random(seed); elapsed() < seconds;) run_one(next_input(corpus, words, random), shared);
    std::fflush(nullptr);
    std::_Exit(0);
  }
  int status = 0;
  std::size_t runs = 0;
  bool hangs = false;
  for (double since = 0; waitpid(child, &status, WNOHANG) == 0;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (shared.runs != runs) runs = shared.runs, since = elapsed();
    if (elapsed() - since < 20 * seconds_an_input) continue;
    hangs = true;
    kill(child, SIGKILL);
  }
  std::printf("fuzz_%s: %zu inputs in %.1f s, %.0f a second, seed %llu\n", name, shared.runs, elapsed(),
              static_cast<double>(shared.runs) / elapsed(), static_cast<unsigned long long>(seed));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return 0;
  const std::string file = std::string("fuzz-") + name + "-input";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(shared.input), static_cast<std::streamsize>(shared.size));
  std::printf("fuzz_%s: %s; its input is in %s\n", name,
              hangs            ? "it hangs"
              : shared.is_slow ? "an input takes too long"
                               : "it died",
              std::filesystem::absolute(file).c_str());
  return 1;
}

}  // namespace sinew::fuzz

/// The main function of a target: its name, and words that its inputs are made of.
#define SINEW_FUZZ_MAIN(name, words) \
  int main(int argc, char** argv) { return sinew::fuzz::fuzz(argc, argv, name, words); }
#else
#define SINEW_FUZZ_MAIN(name, words)
#endif
