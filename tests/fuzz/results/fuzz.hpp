/// @file fuzz.hpp
/// A mutation loop: each damaged input in a process of its own, with bounds on its memory and its time.
#pragma once
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace sinew::fuzz {

/// Bytes turned, cut, doubled, copied from elsewhere, and numbers that are on the edge.
inline std::string mutated(std::string text, std::mt19937_64& random, const std::vector<std::string>& words) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
  for (std::size_t times = 1 + below(6); times > 0; --times) {
    const std::size_t at = below(text.size());
    switch (below(7)) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random());
        break;
      case 1:
        if (!text.empty())
          text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ (1U << below(8)));
        break;
      case 2:
        text.resize(at);
        break;
      case 3:
        text.erase(at, below(64));
        break;
      case 4:
        text.insert(at, text.substr(below(text.size()), below(64)));
        break;
      case 5:
        text.insert(at, words[below(words.size())]);
        break;
      default: {  // a number of some bytes: 0, all ones, or large
        const char byte = std::string("\0\xff\x7f\x80", 4)[below(4)];
        for (std::size_t k = 0, size = std::size_t{1} << below(4); k < size && at + k < text.size(); ++k)
          text[at + k] = byte;
      }
    }
  }
  return text;
}

/// Reads inputs until the time is over; the answer is the exit code. `use` returns false where an invariant
/// fails.
inline int run(const char* name, const std::vector<std::string>& corpus,
               const std::vector<std::string>& words, std::size_t memory,
               const std::function<bool(const std::string&)>& use) {
  constexpr unsigned seconds_an_input = 5;
  const char* text = std::getenv("SINEW_FUZZ_SECONDS");
  const std::chrono::duration<double> whole(text ? std::atof(text) : 4.0);
  const auto begin = std::chrono::steady_clock::now();
  std::mt19937_64 random(20240607);
  std::size_t inputs = 0, bad = 0;
  long largest = 0;
  for (; std::chrono::steady_clock::now() - begin < whole; ++inputs) {
    const std::string input =
        inputs < corpus.size() ? corpus[inputs] : mutated(corpus[random() % corpus.size()], random, words);
    const pid_t child = fork();
    if (child == 0) {
#ifndef __SANITIZE_ADDRESS__
      const rlimit bound{memory, memory};
      setrlimit(RLIMIT_AS, &bound);
#endif
      alarm(seconds_an_input);
      _exit(use(input) ? 0 : 1);
    }
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    largest = std::max(largest, used.ru_maxrss);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
    ++bad;
    const std::string file = std::string("fuzz-") + name + '-' + std::to_string(inputs);
    if (std::FILE* out = std::fopen(file.c_str(), "wb")) {
      std::fwrite(input.data(), 1, input.size(), out);
      std::fclose(out);
    }
    std::printf("%s: input %zu: %s %d, kept as %s\n", name, inputs, WIFSIGNALED(status) ? "signal" : "exit",
                WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status), file.c_str());
  }
  std::printf("%s: %zu inputs, %zu failed, at most %ld kB\n", name, inputs, bad, largest);
  return bad == 0 ? 0 : 1;
}

}  // namespace sinew::fuzz
