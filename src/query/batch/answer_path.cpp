#include "query/batch/answer_path.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

namespace sinew::inline v1 {
namespace {

constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();  ///< what is no index leads there

}  // namespace

bool AnswerPath::is_path(std::string_view path) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  const auto take = [&](const auto& is_part) {
    const auto end = std::ranges::find_if_not(path, is_part);
    const auto size = static_cast<std::size_t>(end - path.begin());
    path.remove_prefix(size);
    return size;
  };
  const auto take_one = [&](char c) {
    if (!path.starts_with(c)) return false;
    path.remove_prefix(1);
    return true;
  };
  constexpr std::size_t most_digits = 9;
  do {
    if (take(is_letter) == 0) return false;
    while (take_one('[')) {
      const std::size_t digits = take([](char c) { return c >= '0' && c <= '9'; });
      if (digits == 0 || digits > most_digits || !take_one(']')) return false;
    }
  } while (take_one('.'));
  return path.empty();
}

AnswerPath::AnswerPath(std::string_view path) {
  constexpr std::string_view count = ".count";
  if (path.ends_with(count)) {
    counts_ = true;
    path.remove_suffix(count.size());
  }
  while (!path.empty()) {
    if (path.front() == '.') path.remove_prefix(1);
    if (path.starts_with('[')) {
      const std::size_t end = std::min(path.find(']'), path.size());
      std::size_t index = 0;
      const auto [last, error] = std::from_chars(path.data() + 1, path.data() + end, index);
      if (error != std::errc() || last != path.data() + end) index = nowhere;
      steps_.emplace_back(index);
      path.remove_prefix(std::min(end + 1, path.size()));
    } else {
      const std::size_t end = std::min(path.find_first_of(".["), path.size());
      steps_.emplace_back(std::string(path.substr(0, end)));
      path.remove_prefix(end);
    }
  }
}

std::optional<double> AnswerPath::number(const Value& answer) const {
  const Value* node = &answer;
  std::span<const double> numbers;  // of a row of a block, once a step has led there
  std::optional<double> entry;
  for (const auto& step : steps_) {
    if (entry) return {};
    if (const auto* key = std::get_if<std::string>(&step)) {
      node = node ? node->find(*key) : nullptr;
      if (!node) return {};
      continue;
    }
    const std::size_t index = std::get<std::size_t>(step);
    if (node && node->block() && node->block()->columns() > 0) {
      if (index >= node->size()) return {};
      numbers = node->block()->row(index);
      node = nullptr;
    } else if (node && node->items()) {
      if (index >= node->size()) return {};
      node = &(*node->items())[index];
    } else {
      if (node && node->block()) numbers = node->block()->numbers();
      node = nullptr;
      if (index >= numbers.size()) return {};
      entry = numbers[index];
    }
  }
  if (counts_) {
    if (node) return node->is_list() ? std::optional<double>(node->size()) : std::nullopt;
    return entry ? std::nullopt : std::optional<double>(numbers.size());
  }
  if (!node) return entry;
  if (const bool* is = node->boolean()) return *is ? 1 : 0;
  return node->number();
}

}  // namespace sinew::inline v1
