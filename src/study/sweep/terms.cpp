#include "study/sweep/terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "io/document/quantity.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::size_t highest_power = 20;

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

double value_of(const Monomial& monomial, std::span<const double> columns) {
  double product = monomial.factor;
  for (const std::size_t column : monomial.columns) product *= columns[column];
  return product;
}

class TermParser {
 public:
  TermParser(std::string_view text, std::span<const std::string_view> columns, std::string_view nouns)
      : whole_(text),
        rest_(text),
        columns_(columns),
        nouns_(nouns) {}

  Expected<std::vector<Monomial>> term() {
    std::vector<Monomial> sum;
    double sign = take('-') ? -1 : 1;
    if (sign > 0) take('+');
    do {
      Monomial product{.factor = sign, .columns = {}};
      do {
        if (!factor(product)) return tl::unexpected(errors_);
      } while (take('*') || (!rest_.empty() && is_letter(rest_.front())));
      sum.push_back(std::move(product));
      sign = take('-') ? -1 : take('+') ? 1 : 0;
    } while (sign != 0);
    if (!rest_.empty()) {
      refuse();
      return tl::unexpected(errors_);
    }
    return sum;
  }

 private:
  void skip() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }
  bool take(char c) {
    skip();
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    skip();
    return true;
  }
  std::string_view word(bool (*is_part)(char)) {
    std::size_t size = 0;
    while (size < rest_.size() && is_part(rest_[size])) ++size;
    const std::string_view found = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return found;
  }

  /// The characters of a power of ten that follow a number: `e-3`; 0 where none does.
  std::size_t exponent_size() const {
    if (rest_.empty() || (rest_.front() != 'e' && rest_.front() != 'E')) return 0;
    std::size_t size = rest_.size() > 1 && (rest_[1] == '-' || rest_[1] == '+') ? 2 : 1;
    const std::size_t sign = size;
    while (size < rest_.size() && is_digit(rest_[size])) ++size;
    return size > sign ? size : 0;
  }

  /// `2`, `0.5`, `1e-3`.
  bool number(Monomial& product) {
    const std::string_view from = rest_;
    word([](char c) { return is_digit(c) || c == '.'; });
    const std::size_t digits = from.size() - rest_.size(), exponent = exponent_size();
    const std::string_view power = rest_.substr(0, exponent);
    for (const std::string_view column : columns_)
      if (exponent > 0 && (power == column || power.substr(0, 1) == column)) return refuse_power(column);
    rest_.remove_prefix(exponent);
    const auto value = parse_number(from.substr(0, digits + exponent));
    if (!value) return refuse();
    product.factor *= *value;
    skip();
    return true;
  }

  /// A number, or a column with a power.
  bool factor(Monomial& product) {
    skip();
    if (!rest_.empty() && (is_digit(rest_.front()) || rest_.front() == '.')) return number(product);
    const std::string_view name = word([](char c) { return is_letter(c) || is_digit(c); });
    if (name.empty()) return refuse();
    const auto found = std::ranges::find(columns_, name);
    if (found == columns_.end()) {
      errors_ = {
          {"unknown_column", "",
           fmt::format("{} is no {}; there are {}.", in_quotes(name), nouns_, fmt::join(columns_, ", "))}};
      return false;
    }
    std::size_t power = 1;
    if (take('^')) {
      const auto value = parse_number(word(is_digit));
      if (!value || *value > static_cast<double>(highest_power)) return refuse();
      power = static_cast<std::size_t>(*value);
    }
    product.columns.insert(product.columns.end(), power, static_cast<std::size_t>(found - columns_.begin()));
    skip();
    return true;
  }

  /// `1e3` where e3 is a column.
  bool refuse_power(std::string_view column) {
    errors_ = {
        {"bad_term", "",
         fmt::format("{} has a number right before {}, which is a power of ten or the column {}; put a * "
                     "between for the product, or write the number without a power of ten.",
                     in_quotes(whole_), in_quotes(rest_), column)}};
    return false;
  }

  bool refuse() {
    errors_ = {{"bad_term", "",
                fmt::format("{} cannot be read at {}; a term is made of columns, whole powers up to {} and "
                            "numbers: \"e1^2 - e2^2\", \"2 e1*e2\".",
                            in_quotes(whole_), rest_.empty() ? "its end" : in_quotes(rest_), highest_power)}};
    return false;
  }

  std::string_view whole_, rest_;
  std::span<const std::string_view> columns_;
  std::string_view nouns_;
  Errors errors_;
};

}  // namespace

Expected<std::vector<Monomial>> parse_term(std::string_view text, std::span<const std::string_view> columns,
                                           std::string_view nouns) {
  return TermParser(text, columns, nouns).term();
}

double value_of(std::span<const Monomial> term, std::span<const double> columns) {
  double sum = 0;
  for (const Monomial& monomial : term) sum += value_of(monomial, columns);
  return sum;
}

double size_of(std::span<const Monomial> term, std::span<const double> columns) {
  double sum = 0;
  for (const Monomial& monomial : term) sum += std::abs(value_of(monomial, columns));
  return sum;
}

}  // namespace sinew::inline v1
