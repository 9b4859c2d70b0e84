#include "recordings.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace sinew::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t max_listed = 500;
constexpr auto patience = std::chrono::seconds(2);  // of reading files that are new to the list
constexpr std::size_t max_picture = std::size_t{16} << 20U;
constexpr std::string_view first_line = "# sinew recording, version ";
/// In the order of severity.
constexpr std::string_view words[] = {"EXACT",       "PARTLY SLACK", "SLACK",
                                      "UNREACHABLE", "NO DATA",      "OVER-TENSIONED"};

bool is_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  return !name.empty() && name.size() <= 200 && name[0] != '.' && std::ranges::all_of(name, is_plain);
}

/// A plain file, and no link to one; line by line, whatever its size.
class Lines {
 public:
  explicit Lines(const fs::path& path)
      : file_(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)) {
    struct stat status {};
    if (file_ >= 0 && (::fstat(file_, &status) != 0 || !S_ISREG(status.st_mode))) close();
    size_ = is_open() ? static_cast<std::uintmax_t>(status.st_size) : 0;
  }
  ~Lines() { close(); }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  bool is_open() const { return file_ >= 0; }
  std::uintmax_t size() const { return size_; }
  /// With its newline, if it has one; good until the next call. Empty: there is no more.
  std::string_view next() {
    std::size_t end;
    while ((end = text_.find('\n', at_)) == std::string::npos && text_.size() - at_ < longest) {
      text_.erase(0, at_);
      at_ = 0;
      const std::size_t before = text_.size();
      text_.resize(before + block);
      const ssize_t count = ::read(file_, text_.data() + before, block);
      text_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
      if (count <= 0) break;
    }
    end = text_.find('\n', at_);
    const std::size_t from = at_;
    at_ = end == std::string::npos ? text_.size() : end + 1;
    return std::string_view(text_).substr(from, at_ - from);
  }

 private:
  static constexpr std::size_t block = std::size_t{1} << 18U, longest = std::size_t{1} << 20U;
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }
  int file_;
  std::uintmax_t size_ = 0;
  std::string text_;
  std::size_t at_ = 0;
};

/// Which columns are looked at.
class Columns {
 public:
  void read(std::string_view line) {
    std::size_t index = 0;
    for (std::string_view rest = line;; ++index) {
      const std::size_t comma = rest.find(',');
      const std::string_view name = rest.substr(0, comma);
      if (name.ends_with("_state")) states_.push_back(index);
      if (name == "event") event_ = index;
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
  }
  /// Of a row its states, and whether it is of an event. False: it is not whole.
  bool look(std::string_view row, std::vector<std::string_view>& states, std::string_view& event) const {
    states.clear();
    bool has_event = event_ == 0;
    std::size_t index = 0, next = 0;
    for (std::string_view rest = row;; ++index) {
      const std::size_t comma = rest.find(',');
      const std::string_view field = rest.substr(0, comma);
      if (next < states_.size() && states_[next] == index) {
        states.push_back(field);
        ++next;
      }
      if (index == event_ && event_ > 0) {
        event = field;
        has_event = true;
        break;  // a text in quotes follows
      }
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    return has_event && states.size() == states_.size() && row[0] >= '0' && row[0] <= '9' &&
           row.ends_with('\n');
  }

 private:
  std::vector<std::size_t> states_;
  std::size_t event_ = 0;
};

/// `# robot: NAME`
std::string_view value_of(std::string_view line, std::string_view key) {
  if (!line.starts_with("# ") || !line.substr(2).starts_with(key)) return {};
  std::string_view value = line.substr(2 + key.size());
  if (!value.starts_with(": ")) return {};
  value.remove_prefix(2);
  return value.substr(0, value.find('\n'));
}

double number_of(std::string_view text) {
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::size_t severity(std::string_view word) {
  return static_cast<std::size_t>(std::ranges::find(words, word) - std::begin(words));
}

int version_of(std::string_view line) {
  return line.starts_with(first_line) ? static_cast<int>(number_of(line.substr(first_line.size()))) : 0;
}

/// What its comments say. The line after them is returned.
std::string_view read_head(Lines& lines, RecordingSummary& summary) {
  std::string_view line;
  while (!(line = lines.next()).empty() && line[0] == '#') {
    if (const auto robot = value_of(line, "robot"); !robot.empty()) summary.robot = robot;
    if (const auto table = value_of(line, "table"); !table.empty()) summary.table = table;
    if (const auto date = value_of(line, "date"); !date.empty()) summary.start = date;
  }
  return line;
}

/// Nothing where the file is no recording. @param is_whole else only its head is read
std::optional<RecordingSummary> read_summary(const fs::path& path, bool is_whole) {
  Lines lines(path);
  if (!lines.is_open()) return {};
  RecordingSummary summary;
  summary.version = version_of(lines.next());
  if (summary.version < 1) return {};
  Columns columns;
  columns.read(read_head(lines, summary));
  std::vector<std::string_view> states;
  std::string_view event;
  std::size_t worst = 0;
  for (std::string_view row; is_whole && !(row = lines.next()).empty();) {
    if (!columns.look(row, states, event)) continue;
    summary.duration = std::max(summary.duration, number_of(row));
    summary.rows += event.empty();
    summary.pictures += event == "snapshot";
    for (const std::string_view state : states)
      if (const std::size_t of = severity(state); of < std::size(words)) {
        worst = std::max(worst, of);
        summary.worst = words[worst];
      }
  }
  return summary;
}

Json row_of(const std::string& name, std::uintmax_t size, const RecordingSummary& summary, bool is_read) {
  Json row{{"name", name},           {"robot", summary.robot}, {"table", summary.table},
           {"start", summary.start}, {"bytes", size},          {"version", summary.version}};
  row["duration"] = is_read ? Json(summary.duration) : Json(nullptr);
  row["rows"] = is_read ? Json(summary.rows) : Json(nullptr);
  row["worst"] = is_read && !summary.worst.empty() ? Json(summary.worst) : Json(nullptr);
  row["snapshots"] = is_read ? Json(summary.pictures) : Json(nullptr);
  return row;
}

Reply unknown_recording() {
  return refused(404, "unknown_recording", "recording",
                 "no recording has this name; GET /api/recordings lists them");
}

}  // namespace

Reply Recordings::list() {
  std::vector<std::string> names;
  std::error_code ignored;
  for (fs::directory_iterator entry(folder_, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::string file = entry->path().filename().string();
    if (file.ends_with(".csv") && is_name(file)) names.push_back(file.substr(0, file.size() - 4));
  }
  std::ranges::sort(names, std::greater<>());  // they begin with their date
  const std::size_t found = names.size();
  names.resize(std::min(names.size(), max_listed));
  const auto until = std::chrono::steady_clock::now() + patience;
  Json rows = Json::array();
  const std::lock_guard lock(mutex_);
  for (const std::string& name : names) {
    const fs::path path = folder_ / (name + ".csv");
    const auto size = fs::file_size(path, ignored);
    const auto time = fs::last_write_time(path, ignored);
    const auto known = known_.find(name);
    if (known != known_.end() && known->second.size == size && known->second.time == time) {
      rows.push_back(row_of(name, size, known->second.summary, true));
      continue;
    }
    const bool is_whole = std::chrono::steady_clock::now() < until;
    const auto summary = read_summary(path, is_whole);
    if (!summary) continue;
    if (is_whole) known_[name] = {size, time, *summary};
    rows.push_back(row_of(name, size, *summary, is_whole));
  }
  if (known_.size() > 2 * max_listed) known_.clear();
  const Json json{{"recordings", rows}, {"left_out", found - names.size()}};
  return {200, json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

Reply Recordings::text(std::string_view name, int every) const {
  if (every < 0) return refused(400, "out_of_range", "every", "give a whole number from 1 on");
  if (!is_name(name)) return unknown_recording();
  Lines lines(folder_ / (std::string(name) + ".csv"));
  if (!lines.is_open()) return unknown_recording();
  std::string_view line = lines.next();
  if (version_of(line) < 1) return unknown_recording();
  std::string text;
  for (; !line.empty() && line[0] == '#'; line = lines.next()) text += line;
  Columns columns;
  columns.read(line);
  text += line;
  std::vector<std::string_view> states, kept;
  std::string before;
  std::string_view event;
  const auto step = static_cast<std::size_t>(std::max(every, 1));
  for (std::size_t count = 0; !(line = lines.next()).empty();) {
    const bool is_whole = columns.look(line, states, event);
    std::string now;
    for (const std::string_view state : states) (now += state) += ',';
    const bool is_event = is_whole && !event.empty();
    if (!is_whole || is_event || now != before || count % step == 0) text += line;
    count += !is_event;
    before = std::move(now);
    if (text.size() > most_)
      return refused(413, "too_large", "recording",
                     fmt::format("it has {} bytes; ask for fewer rows, as ?every={}", lines.size(),
                                 step * (lines.size() / most_ + 2)));
  }
  return {200, std::move(text), "text/csv; charset=utf-8"};
}

Reply Recordings::picture(std::string_view name, std::string_view number) const {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (is_name(name) && number.size() == 3 && std::ranges::all_of(number, is_digit))
    for (const auto& [ending, type] : {std::pair{"jpg", "image/jpeg"}, std::pair{"png", "image/png"}}) {
      Lines file(folder_ / fmt::format("{}-{}.{}", name, number, ending));
      if (!file.is_open() || file.size() > max_picture) continue;
      std::string bytes;
      for (std::string_view part; !(part = file.next()).empty();) bytes += part;
      return {200, std::move(bytes), type};
    }
  return refused(404, "unknown_snapshot", "snapshot", "this recording has no snapshot of this number");
}

}  // namespace sinew::server
