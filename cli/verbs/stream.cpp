/// query: JSON lines in, JSON lines out, in order. No line ends the stream.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>

#include "request.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

constexpr std::size_t longest_line = std::size_t{1} << 20U;

/// Lines of stdin in bounded memory; what a line has beyond `longest_line` is dropped.
class Lines {
 public:
  enum class Kind { whole, too_long, end };

  Kind next(std::string& line) {
    line.clear();
    bool is_cut = false, has_any = false;
    while (!interrupted() && (begin_ < end_ || fill())) {
      has_any = true;
      const char* from = buffer_.data() + begin_;
      const void* found = std::memchr(from, '\n', end_ - begin_);
      const std::size_t size =
          found ? static_cast<std::size_t>(static_cast<const char*>(found) - from) : end_ - begin_;
      const std::size_t room = longest_line - line.size();
      is_cut |= size > room;
      line.append(from, std::min(size, room));
      begin_ += size + (found ? 1 : 0);
      if (found) return is_cut ? Kind::too_long : Kind::whole;
    }
    if (interrupted() || !has_any) return Kind::end;
    return is_cut ? Kind::too_long : Kind::whole;  // the last line may lack its line break
  }

  int error() const { return error_; }
  /// Whether the next line is read already: it does not have to be waited for.
  bool has_next() const { return std::memchr(buffer_.data() + begin_, '\n', end_ - begin_) != nullptr; }

 private:
  bool fill() {
    const ssize_t count = ::read(STDIN_FILENO, buffer_.data(), buffer_.size());
    if (count < 0 && errno != EINTR) error_ = errno;
    begin_ = 0;
    end_ = count > 0 ? static_cast<std::size_t>(count) : 0;
    return count > 0;
  }

  std::array<char, 65536> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  int error_ = 0;
};

void answer_to(Session& session, Lines::Kind kind, const std::string& line, std::string& answer) {
  try {
    if (kind == Lines::Kind::whole)
      session.answer(line, answer);
    else
      answer = json_error(
          {{"too_large", "query", "the line is longer than 1 MiB; ask in smaller queries, one a line."}});
  } catch (const std::exception& error) {
    answer =
        json_error({{"internal", "query", fmt::format("this query failed inside sinew: {}", error.what())}});
  }
}

/// Answers on their way out. Writing costs as much as a quick answer: where nobody looks on, those of lines
/// that wait together go together. Such an answer waits for the next ones, at most this long and one
/// question.
class Answers {
 public:
  void add(std::string_view answer) {
    if (lines_.empty()) first_ = Clock::now();
    lines_.append(answer) += '\n';
  }
  bool are_due() const {
    return is_watched_ || lines_.size() >= most_ || Clock::now() - first_ >= longest_wait_;
  }
  void write() {
    print(lines_);
    lines_.clear();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most_ = 65536;  // bytes
  static constexpr std::chrono::milliseconds longest_wait_{2};

  const bool is_watched_ = isatty(STDOUT_FILENO) != 0;
  std::string lines_;
  Clock::time_point first_;
};

}  // namespace

int run_query(const Arguments& arguments) {
  auto session = Session::open(arguments.operand());
  if (!session) return refuse(arguments.verb, session.error());
  finish_what_is_begun();
  session->stop_on(stop_token());  // the line under way is answered, with status stopped
  Lines lines;
  Answers answers;
  std::string line, answer;
  for (Lines::Kind kind; (kind = lines.next(line)) != Lines::Kind::end;) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) {
      answer_to(*session, kind, line, answer);
      answers.add(answer);
    }
    if (!lines.has_next() || answers.are_due()) answers.write();
  }
  answers.write();
  if (lines.error()) {
    message(fmt::format("sinew query: stdin cannot be read: {}", std::strerror(lines.error())));
    return internal_error;
  }
  return interrupted() ? stopped : solved;
}

}  // namespace sinew::cli
