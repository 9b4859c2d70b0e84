/// query: JSON lines in, JSON lines out, in order. No line ends the stream.
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
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

std::string answer_of(Session& session, Lines::Kind kind, const std::string& line) {
  try {
    if (kind == Lines::Kind::whole) return session.answer(line);
    return json_error(
        {{"too_large", "query", "the line is longer than 1 MiB; ask in smaller queries, one a line."}});
  } catch (const std::exception& error) {
    return json_error(
        {{"internal", "query", fmt::format("this query failed inside sinew: {}", error.what())}});
  }
}

}  // namespace

int run_query(const Arguments& arguments) {
  auto session = Session::open(arguments.operand());
  if (!session) return refuse(arguments.verb, session.error());
  finish_what_is_begun();
  session->stop_on(stop_token());  // the line under way is answered, with status stopped
  Lines lines;
  std::string line;
  for (Lines::Kind kind; (kind = lines.next(line)) != Lines::Kind::end;) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    print(answer_of(*session, kind, line) + '\n');
  }
  if (lines.error()) {
    message(fmt::format("sinew query: stdin cannot be read: {}", std::strerror(lines.error())));
    return internal_error;
  }
  return interrupted() ? stopped : solved;
}

}  // namespace sinew::cli
