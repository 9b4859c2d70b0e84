/// @file answer_path.hpp
/// Places in the trees of answers, `legs[0].tendon_lengths[1]`, taken apart once.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "query/answer/value.hpp"

namespace sinew::inline v1 {

class AnswerPath {
 public:
  explicit AnswerPath(std::string_view path);

  /// Whether it is one: names parted by points, each with whole numbers in brackets after it, and `.count` at
  /// the end of the place of a list. Whether an answer has something there is another question.
  static bool is_path(std::string_view path);

  /// The number there; 1 and 0 for true and false; of a list under `.count` its length. Nothing where there
  /// is none.
  std::optional<double> number(const Value& answer) const;

 private:
  std::vector<std::variant<std::string, std::size_t>> steps_;
  bool counts_ = false;
};

/// A name for what is there, where nobody gave one: `legs_0_force`.
inline std::string name_of_place(std::string_view path) {
  std::string name;
  for (const char c : path)
    if (c == '.' || c == '[')
      name += '_';
    else if (c != ']')
      name += c;
  return name;
}

}  // namespace sinew::inline v1
