#include "recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>

namespace sinew::server::device {
namespace {

constexpr int max_pictures = 999;

/// Without what would end a line.
std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7F') c = ' ';
  return line;
}

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S%z", &local);
  return text.data();
}

std::string head_text(const RecordingHead& head, std::string_view robot_text) {
  std::string text =
      fmt::format("# sinew recording, version {}\n# robot: {}\n# table: {:08X}\n# model: {}\n# date: {}\n",
                  Recording::version, one_line(head.robot), head.table, head.model, date_now());
  if (head.tension_limit > 0) text += fmt::format("# tension limit [N]: {:g}\n", head.tension_limit);
  text += "# file:\n";
  while (!robot_text.empty()) {
    const std::string_view line = robot_text.substr(0, robot_text.find('\n'));
    text += line.empty() ? "#" : "#   ";
    (text += one_line(line)) += '\n';
    robot_text.remove_prefix(std::min(line.size() + 1, robot_text.size()));
  }
  return text + "time[s]" + head.columns + '\n';
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string field = "\"";
  for (const char c : one_line(text)) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

void Recording::begin(const std::string& name, const RecordingHead& head, double now) {
  end();
  error_.clear();
  name_ = name;
  began_ = now;
  count_ = pictures_ = homings_ = 0;
  is_on_ = true;
  is_open_ = false;
  if (!writer_.open(folder_ / (name + ".csv"), head_text(head, robot_text_), ++number_))
    error_ = "the disk has not taken the last recording yet";
}

bool Recording::append(double now, std::string_view rest) {
  if (!is_on_ || !error_.empty()) return false;
  if (!writer_.append(fmt::format("{:.3f}{}\n", now - began_, rest)))
    error_ = "the disk takes nothing any more";
  return error_.empty();
}

void Recording::row(double now, std::string_view rest) { count_ += append(now, rest); }
void Recording::event(double now, std::string_view rest) { append(now, rest); }

std::string Recording::picture(std::string bytes, std::string_view extension) {
  if (pictures_ >= max_pictures) return {};
  const std::string file = fmt::format("{}-{:03}.{}", name_, pictures_ + 1, extension);
  if (!writer_.write_whole(folder_ / file, std::move(bytes))) return {};
  ++pictures_;
  return file;
}

std::string Recording::homing(std::string json) {
  if (!error_.empty()) return {};
  ++homings_;
  std::string file = name_ + (homings_ > 1 ? fmt::format("-homing-{}.json", homings_) : "-homing.json");
  if (writer_.write_whole(folder_ / file, std::move(json))) return file;
  error_ = "the disk takes nothing any more";
  return {};
}

void Recording::poll() {
  if (!is_on_) return;
  const FileWriter::News news = writer_.news(number_);
  is_open_ = news.is_open;
  if (error_.empty()) error_ = news.error;
}

void Recording::end() {
  if (is_on_) writer_.close();
  is_on_ = false;
}

}  // namespace sinew::server::device
