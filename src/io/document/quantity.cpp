#include "io/document/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) - begin + 1);
}
namespace {

struct Words {
  Dimension dimension;
  std::string_view unit;
  std::string_view noun;
  std::string_view advice;
};

constexpr std::array<Words, 19> words{{
    {Dimension::number, "", "a number", "a plain number (0.5)"},
    {Dimension::count, "", "a whole number", "a whole number (3)"},
    {Dimension::length, "m", "a length", R"(a length ("0.2 m", "200 mm", or 0.2 for metres))"},
    {Dimension::angle, "rad", "an angle", R"(an angle ("0.5 rad", "30 deg", or 0.5 for radians))"},
    {Dimension::curvature, "1/m", "a curvature", R"(a curvature ("5 1/m", "0.005 1/mm", or 5 for 1/metre))"},
    {Dimension::force, "N", "a force", R"(a force ("2 N", "50 mN", or 2 for newtons))"},
    {Dimension::moment, "N m", "a moment", R"(a moment ("0.1 N m", "100 N mm", or 0.1 for newton metres))"},
    {Dimension::pressure, "Pa", "a pressure", R"(a pressure ("60 GPa", "5 kPa", or 6e10 for pascals))"},
    {Dimension::mass, "kg", "a mass", R"(a mass ("0.2 kg", "200 g", or 0.2 for kilograms))"},
    {Dimension::density, "kg/m^3", "a density",
     R"(a density ("7850 kg/m^3", "7.85 g/cm^3", or 7850 for kg/m^3))"},
    {Dimension::acceleration, "m/s^2", "an acceleration",
     R"(an acceleration ("9.81 m/s^2", or 9.81 for m/s^2))"},
    {Dimension::time, "s", "a time", R"(a time ("0.5 s", "500 ms", or 0.5 for seconds))"},
    {Dimension::line_load, "N/m", "a load by length",
     R"(a load by length ("0.5 N/m", "500 mN/m", or 0.5 for newtons a metre))"},
    {Dimension::speed, "m/s", "a speed", R"(a speed ("5 mm/s", or 0.005 for m/s))"},
    {Dimension::angular_speed, "rad/s", "an angular speed",
     R"(an angular speed ("0.5 rad/s", "30 deg/s", or 0.5 for rad/s))"},
    {Dimension::angular_acceleration, "rad/s^2", "an angular acceleration",
     R"(an angular acceleration ("2 rad/s^2", "90 deg/s^2", or 2 for rad/s^2))"},
    {Dimension::rigidity, "N m^2", "a rigidity",
     R"(a rigidity ("0.01 N m^2", "100 N mm^2", or 0.01 for newton square metres))"},
    {Dimension::compliance, "m/N", "a compliance",
     R"(a compliance ("5e-5 m/N", "0.05 mm/N", or 5e-5 for metres a newton))"},
    {Dimension::line_mass, "kg/m", "a mass by length",
     R"(a mass by length ("0.01 kg/m", "10 g/m", or 0.01 for kilograms a metre))"},
}};
static_assert([] {
  for (std::size_t i = 0; i < words.size(); ++i)
    if (static_cast<std::size_t>(words[i].dimension) != i) return false;
  return true;
}());

const Words& words_of(Dimension dimension) { return words[static_cast<std::size_t>(dimension)]; }

/// SI = (number · 10^shift) · times / over · after. The power of ten is put into the text of the number, so
/// that the one rounding is that of reading it; deg divides first, so that 90, 180, 270 and 360 deg are
/// exact.
struct Unit {
  Dimension dimension;
  std::string_view symbol;
  int shift = 0;
  bool is_alias = false;  // understood, not listed
  double times = 1;
  double over = 1;
  double after = 1;
};

constexpr bool alias = true;
constexpr std::array units{
    Unit{Dimension::length, "m"},
    Unit{Dimension::length, "mm", -3},
    Unit{Dimension::length, "cm", -2},
    Unit{Dimension::length, "um", -6},
    Unit{Dimension::length, "in", 0, false, 254, 10000},
    Unit{Dimension::angle, "rad"},
    Unit{Dimension::angle, "mrad", -3},
    Unit{Dimension::angle, "deg", 0, false, 1, 180, std::numbers::pi},
    Unit{Dimension::angle, "°", 0, alias, 1, 180, std::numbers::pi},
    Unit{Dimension::curvature, "1/m"},
    Unit{Dimension::curvature, "1/mm", 3},
    Unit{Dimension::curvature, "/m", 0, alias},
    Unit{Dimension::curvature, "/mm", 3, alias},
    Unit{Dimension::force, "N"},
    Unit{Dimension::force, "mN", -3},
    Unit{Dimension::force, "kN", 3},
    Unit{Dimension::moment, "N m"},
    Unit{Dimension::moment, "N mm", -3},
    Unit{Dimension::moment, "mN m", -3},
    Unit{Dimension::moment, "Nm", 0, alias},
    Unit{Dimension::moment, "Nmm", -3, alias},
    Unit{Dimension::moment, "mNm", -3, alias},
    Unit{Dimension::pressure, "Pa"},
    Unit{Dimension::pressure, "kPa", 3},
    Unit{Dimension::pressure, "MPa", 6},
    Unit{Dimension::pressure, "GPa", 9},
    Unit{Dimension::mass, "kg"},
    Unit{Dimension::mass, "g", -3},
    Unit{Dimension::density, "kg/m^3"},
    Unit{Dimension::density, "g/cm^3", 3},
    Unit{Dimension::density, "kg/m3", 0, alias},
    Unit{Dimension::density, "g/cm3", 3, alias},
    Unit{Dimension::acceleration, "m/s^2"},
    Unit{Dimension::acceleration, "mm/s^2", -3},
    Unit{Dimension::acceleration, "m/s2", 0, alias},
    Unit{Dimension::time, "s"},
    Unit{Dimension::time, "ms", -3},
    Unit{Dimension::time, "us", -6},
    Unit{Dimension::line_load, "N/m"},
    Unit{Dimension::line_load, "mN/m", -3},
    Unit{Dimension::line_load, "N/mm", 3},
    Unit{Dimension::speed, "m/s"},
    Unit{Dimension::speed, "mm/s", -3},
    Unit{Dimension::angular_speed, "rad/s"},
    Unit{Dimension::angular_speed, "deg/s", 0, false, 1, 180, std::numbers::pi},
    Unit{Dimension::angular_acceleration, "rad/s^2"},
    Unit{Dimension::angular_acceleration, "deg/s^2", 0, false, 1, 180, std::numbers::pi},
    Unit{Dimension::rigidity, "N m^2"},
    Unit{Dimension::rigidity, "N mm^2", -6},
    Unit{Dimension::compliance, "m/N"},
    Unit{Dimension::compliance, "mm/N", -3},
    Unit{Dimension::line_mass, "kg/m"},
    Unit{Dimension::line_mass, "g/m", -3},
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() && is_digit(text[end])) ++end;
  return end;
}

/// Bytes of the decimal number that the text starts with; 0 if it starts with none.
std::size_t number_size(std::string_view text) {
  const std::size_t begin = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  std::size_t end = digits(text, begin);
  std::size_t count = end - begin;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction = digits(text, end + 1);
    count += fraction - end - 1;
    end = fraction;
  }
  if (count == 0) return 0;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    const std::size_t sign = end + 1 < text.size() && (text[end + 1] == '+' || text[end + 1] == '-') ? 1 : 0;
    const std::size_t exponent = digits(text, end + 1 + sign);
    if (exponent > end + 1 + sign) end = exponent;
  }
  return end;
}

/// A text as measured by `number_size`, times a power of ten, rounded once; nothing where it leaves the
/// doubles.
std::optional<double> value_of(std::string_view number, int shift) {
  if (number.starts_with('+')) number.remove_prefix(1);
  const std::size_t mantissa = std::min(number.find_first_of("eE"), number.size());
  int exponent = 0;
  if (mantissa < number.size()) {
    const char* begin = number.data() + mantissa + 1 + (number[mantissa + 1] == '+' ? 1 : 0);
    const auto parsed = std::from_chars(begin, number.data() + number.size(), exponent);
    if (parsed.ec != std::errc() || std::abs(exponent) > 100'000) return {};
  }
  const std::string shifted = fmt::format("{}e{}", number.substr(0, mantissa), exponent + shift);
  double value = 0;
  const auto parsed = std::from_chars(shifted.data(), shifted.data() + shifted.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != shifted.data() + shifted.size()) return {};
  return value;
}

/// One spelling of a unit: µ is u, a product is a space, a power is ^.
std::string plain_unit(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> spellings[] = {
      {"µ", "u"},  {"μ", "u"},  {"·", " "},  {"⋅", " "}, {"*", " "},
      {"\t", " "}, {"²", "^2"}, {"³", "^3"}, {"º", "°"}};
  std::string result;
  while (!text.empty()) {
    std::string_view from = text.substr(0, 1), to = from;
    for (const auto& [spelling, plain] : spellings)
      if (text.starts_with(spelling)) from = spelling, to = plain;
    const bool is_needless = to == " " && (result.empty() || result.back() == ' ' || result.back() == '/');
    if (to == "/" && !result.empty() && result.back() == ' ') result.pop_back();
    if (!is_needless) result += to;
    text.remove_prefix(from.size());
  }
  return result;
}

/// "3", "1/2": the texts of the two numbers, and what follows them.
struct Parts {
  std::string_view numerator;
  std::string_view denominator;  // empty: 1
  std::string_view rest;
};

Parts split(std::string_view text) {
  Parts parts{.numerator = text.substr(0, number_size(text)), .denominator = {}, .rest = {}};
  parts.rest = text.substr(parts.numerator.size());
  if (!parts.numerator.empty() && parts.rest.size() > 1 && parts.rest[0] == '/' && is_digit(parts.rest[1])) {
    parts.rest.remove_prefix(1);
    parts.denominator = parts.rest.substr(0, number_size(parts.rest));
    parts.rest.remove_prefix(parts.denominator.size());
  }
  parts.rest = trimmed(parts.rest);
  return parts;
}

std::optional<double> evaluate(const Parts& parts, const Unit& unit) {
  const auto numerator = value_of(parts.numerator, unit.shift);
  const auto denominator = parts.denominator.empty() ? 1.0 : value_of(parts.denominator, 0);
  if (!numerator || !denominator) return {};
  const double value = *numerator * unit.times / (*denominator * unit.over) * unit.after;
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

tl::unexpected<Errors> wrong_unit(std::string_view text, std::string_view written, Dimension dimension) {
  std::vector<std::string_view> known;
  for (const Unit& unit : units)
    if (unit.dimension == dimension && !unit.is_alias) known.push_back(unit.symbol);
  if (known.empty()) {
    return failure("unknown_unit", "",
                   fmt::format("{} has the unknown unit {}; give {}.", in_quotes(text), in_quotes(written),
                               advice(dimension)));
  }
  const std::string_view hint = closest(written, known);
  return failure(
      "unknown_unit", "",
      fmt::format("{} has the unknown unit {}{} Units of {}: {}.", in_quotes(text), in_quotes(written),
                  hint.empty() ? "." : fmt::format("; did you mean {}?", in_quotes(hint)), noun(dimension),
                  fmt::join(known, ", ")));
}

}  // namespace

Expected<double> parse_quantity(std::string_view text, Dimension dimension) {
  const Parts parts = split(trimmed(text));
  if (parts.numerator.empty())
    return failure("not_a_number", "",
                   fmt::format("{} is not a number; give {}.", in_quotes(text), advice(dimension)));
  Unit unit{dimension, ""};
  if (!parts.rest.empty()) {
    const auto found = std::ranges::find(units, plain_unit(parts.rest), &Unit::symbol);
    if (found == units.end()) return wrong_unit(text, parts.rest, dimension);
    if (found->dimension != dimension) {
      return failure(
          "wrong_dimension", "",
          fmt::format("{} is {}; give {}.", in_quotes(text), noun(found->dimension), advice(dimension)));
    }
    unit = *found;
  }
  const auto value = evaluate(parts, unit);
  if (!value) {
    return failure("not_a_number", "",
                   fmt::format("{} is too large or too small for a number; give {}.", in_quotes(text),
                               advice(dimension)));
  }
  if (dimension == Dimension::count && *value != std::floor(*value))
    return failure("not_whole", "",
                   fmt::format("{} is not whole; give {}.", in_quotes(text), advice(dimension)));
  return *value;
}

Expected<Quantity> parse_any_quantity(std::string_view text) {
  const auto plain = parse_quantity(text, Dimension::number);
  if (plain) return Quantity{*plain, Dimension::number};
  for (const Words& word : words)
    if (const auto value = parse_quantity(text, word.dimension)) return Quantity{*value, word.dimension};
  return tl::unexpected(plain.error());
}

std::optional<double> parse_number(std::string_view text) {
  const std::size_t size = number_size(text);
  if (size == 0 || size != text.size()) return {};
  return value_of(text, 0);
}

std::string_view unit(Dimension dimension) { return words_of(dimension).unit; }

std::string_view noun(Dimension dimension) { return words_of(dimension).noun; }

std::string_view advice(Dimension dimension) { return words_of(dimension).advice; }

std::string human(double si, Dimension dimension) {
  double value = si + 0.0;  // no "-0"
  std::string_view symbol = unit(dimension);
  if (dimension == Dimension::length && std::abs(value) < 1000) {
    value *= 1000;
    symbol = "mm";
  } else if (dimension == Dimension::speed && std::abs(value) < 1) {
    value *= 1000;
    symbol = "mm/s";
  } else if (dimension == Dimension::angle) {
    value = value / std::numbers::pi * 180;
    symbol = "deg";
  }
  return fmt::format("{:.6g}{}{}", value, symbol.empty() ? "" : " ", symbol);
}

std::string si_text(double value) {
  std::array<char, 32> buffer{};
  const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), written.ptr};
}

}  // namespace sinew::inline v1
