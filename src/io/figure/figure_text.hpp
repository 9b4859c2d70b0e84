/// @file figure_text.hpp
/// Texts of figures: literal, but for parts that are marked as a symbol, an index or an exponent. The marks
/// are structure, not characters, so that no text of a file can be one.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace sinew::inline v1 {

class Text {
 public:
  enum class Style { upright, italic, subscript, superscript };
  struct Part {
    std::string text;
    Style style = Style::upright;
    bool operator==(const Part&) const = default;
  };

  Text() = default;
  Text(std::string_view literal, Style style = Style::upright);
  Text(const std::string& literal) : Text(std::string_view(literal)) {}
  Text(const char* literal) : Text(std::string_view(literal)) {}

  Text& operator+=(const Text& more);
  friend Text operator+(Text first, const Text& second) { return first += second; }

  const std::vector<Part>& parts() const { return parts_; }
  bool empty() const { return parts_.empty(); }
  void clear() { parts_.clear(); }
  std::string plain() const;  ///< without marks
  bool operator==(const Text&) const = default;

 private:
  std::vector<Part> parts_;
};

/// A text of ours with its symbols set: a letter that stands alone, Latin or Greek, is italic; `_` sets the
/// letters and digits after it as an index, `^` a whole number as an exponent: `‖U_p‖`, `e_3`, `x^2`. Not for
/// texts of files.
Text formula(std::string_view text);

/// A unit as journals set it: `deg` is °, `m^4` has an exponent. Anything else is literal.
Text unit_text(std::string_view unit);

/// `tension (N)`; the label alone where there is no unit.
Text with_unit(const Text& label, std::string_view unit);

}  // namespace sinew::inline v1
