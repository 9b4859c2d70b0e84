#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "io/export/export.hpp"

namespace sinew::inline v1 {
namespace {

/// How numbers of a kernel's format are written.
struct Numbers {
  int bits = 0;  ///< 0: as float
  ShortBits fraction{};

  std::string text(double value, int places) const {
    if (bits > 0) return fmt::format("{}", fixed_point(value, places, bits));
    const std::string digits = fmt::format("{:.9g}", value);
    return digits + (digits.find_first_of(".e") == std::string::npos ? ".0f" : "f");
  }
};

constexpr Numbers q15_16{32, {16, 16, 16, 16, 16}}, floats{};
int share_bits(const Numbers& numbers) { return numbers.bits == 16 ? ShortBits::share : 16; }
int loss_bits(const Numbers& numbers) { return numbers.bits == 16 ? ShortBits::loss : 16; }

template <class Values, class Text>
std::string braced(const Values& values, Text text, std::string_view between = ", ") {
  std::string list;
  for (const auto& value : values) list += (list.empty() ? "" : std::string(between)) + text(value);
  return "{" + list + "}";
}

using Rows = std::vector<std::array<double, 2>>;

std::string rows_text(const ControllerTable& table, Rows ControllerSection::*rows, const Numbers& numbers,
                      int places) {
  const auto row = [&](const std::array<double, 2>& pair) {
    return braced(pair, [&](double value) { return numbers.text(value, places); });
  };
  return braced(
      table.sections, [&](const ControllerSection& section) { return braced(section.*rows, row); }, ",\n   ");
}

std::string shares_text(const ControllerTable& table, const Numbers& numbers) {
  if (table.alike) return "{}";
  const int places = share_bits(numbers);
  const auto list = [&](auto value) {
    return braced(table.sections, [&](const ControllerSection& section) {
      return numbers.text(value(section.share), places);
    });
  };
  return fmt::format("{{{}, {}}}", list([](double share) { return share; }),
                     list([](double share) { return 1 / share; }));
}

std::string linear_text(const ControllerTable& table, const Numbers& numbers) {
  return fmt::format("{{{},\n  {},\n  {}}}", shares_text(table, numbers),
                     rows_text(table, &ControllerSection::rows, numbers, numbers.fraction.row),
                     rows_text(table, &ControllerSection::back, numbers, numbers.fraction.back));
}

std::string backbone_text(kernel::Backbone backbone) {
  return backbone == kernel::Backbone::neutral ? "Backbone::neutral" : "Backbone::twin_pivot";
}

std::size_t terms(const ControllerTable& table) {
  std::size_t most = 0;
  for (const ControllerSection& section : table.sections) most = std::max(most, section.series.size());
  return most;
}

std::string chords_text(const ControllerTable& table, const Numbers& numbers) {
  std::vector<ControllerSection> sections(table.sections.begin(),
                                          table.alike ? table.sections.begin() + 1 : table.sections.end());
  for (ControllerSection& section : sections) section.series.resize(terms(table));
  return braced(sections, [&](const ControllerSection& section) {
    return fmt::format(
        "{{{}, {}, {}}}", backbone_text(section.backbone),
        numbers.text(section.half_length, numbers.fraction.half),
        braced(section.series, [&](double value) { return numbers.text(value, loss_bits(numbers)); }));
  });
}

/// On one line of a comment.
std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

std::string q_name(int fraction) { return fmt::format("Q{}.{}", 15 - fraction, fraction); }

std::string head(const ControllerTable& table, std::string_view name) {
  return fmt::format(
      "// Constants of the serial robot {0} for controllers; made by `sinew export --to c-header`.\n"
      "// C++14 without a library: #include needs the folder kernel/include of sinew alone. Lengths in mm, "
      "angles in rad.\n"
      "//   bends    {1}, steps of {2:.6g} rad; per section as sinew writes them: (beta_1, beta_2) of a "
      "joint of twin\n"
      "//            pivots, theta (cos phi, sin phi) of a neutral backbone\n"
      "//   changes  {3}, steps of {4:.6g} mm, > 0 pays out; at most {5:.3g} mm from LSK of the same bends\n"
      "//   model    {8}\n"
      "//   counts   {6}\n"
      "#ifndef SINEW_TABLE_{7}_H\n#define SINEW_TABLE_{7}_H\n\n"
      "#include \"sinew/kernel/controller.h\"\n#include \"sinew/kernel/exact_table.h\"\n\n",
      printable(table.robot), q_name(table.bits.angle), table.angle_step(), q_name(table.bits.length),
      table.length_step(), table.rounding(),
      table.counts_per_mm > 0 ? fmt::format("{:.6g} a mm", table.counts_per_mm)
                              : std::string("one a step: the robot's file names no `motor`"),
      name,
      table.model == kernel::Model::exact ? "exact PCC, by which a controller drives the tendons"
                                          : "LSK, by which a controller drives the tendons");
}

std::string sizes(const ControllerTable& table) {
  return fmt::format(
      "constexpr unsigned char sections = {}, tendons = {};\n"
      "/// Of all integers of the 16-bit table: frames carry it.\n"
      "constexpr __UINT32_TYPE__ hash = 0x{:08x}UL;\n\n"
      "template <class Multiply>\nusing Short = ShortFormat<{}, {}, {}, Multiply, {}>;\n"
      "using Angle = Short<Native>::Angle;\nusing Length = Short<Native>::Length;\n"
      "using Q15_16 = PlainFormat<Fixed<32, 16>>;\nusing Float = PlainFormat<float>;\n\n"
      "constexpr BendLimits<{}, Angle> limits = {{{}, {}}};\n"
      "constexpr MotorCounts<Length> motor = {{{}}};\n"
      "constexpr Length tolerance = Length::from_raw({});  // of a tendon\n\n",
      table.sections.size(), table.tendons, table.hash(), table.bits.angle, table.bits.length,
      table.bits.back, table.bits.half, table.sections.size(),
      braced(table.sections,
             [](const ControllerSection& section) { return backbone_text(section.backbone); }),
      braced(table.sections,
             [&](const ControllerSection& section) { return fmt::format("{}", table.short_limit(section)); }),
      table.counts_per_step(), table.short_tolerance());
}

std::string linear_tables(const ControllerTable& table) {
  const std::string type =
      fmt::format("LinearTable<{}, {}, {{}}, {}>", table.sections.size(), table.tendons, table.alike);
  const Numbers shorts{16, table.bits};
  return fmt::format(
      "/// LSK in 16 bits; Multiply is Native or Portable.\n"
      "template <class Multiply>\nconstexpr {} short_table() {{\n  return {};\n}}\n"
      "constexpr auto table = short_table<Native>();\n\n"
      "constexpr {} table_q15_16 = {};\n\nconstexpr {} table_float = {};\n\n",
      fmt::format(fmt::runtime(type), "Short<Multiply>"), linear_text(table, shorts),
      fmt::format(fmt::runtime(type), "Q15_16"), linear_text(table, q15_16),
      fmt::format(fmt::runtime(type), "Float"), linear_text(table, floats));
}

std::string exact_tables(const ControllerTable& table) {
  const std::string type = fmt::format("ExactTable<{}, {}, {{}}, {}, {}>", table.sections.size(),
                                       table.tendons, table.alike, terms(table));
  return fmt::format(
      "/// Exact PCC.\nconstexpr {} exact_float = {{table_float, {}}};\n"
      "constexpr {} exact_q15_16 = {{table_q15_16, {}}};\n"
      "template <class Multiply>\nconstexpr {} exact_short_table() {{\n  return {{short_table<Multiply>(), "
      "{}}};\n}}\n"
      "constexpr auto exact_short = exact_short_table<Native>();\n\n"
      "/// By which a controller drives the tendons.\nstatic constexpr const auto& model = {};\n",
      fmt::format(fmt::runtime(type), "Float"), chords_text(table, floats),
      fmt::format(fmt::runtime(type), "Q15_16"), chords_text(table, q15_16),
      fmt::format(fmt::runtime(type), "Short<Multiply>"), chords_text(table, {16, table.bits}),
      table.model == kernel::Model::exact ? "exact_short" : "table");
}

}  // namespace

std::string controller_header(const ControllerTable& table, std::string_view name) {
  return head(table, name) + fmt::format("namespace {} {{\nusing namespace sinew::kernel;\n\n", name) +
         sizes(table) + linear_tables(table) + exact_tables(table) +
         fmt::format("\n}}  // namespace {}\n\n#endif\n", name);
}

}  // namespace sinew::inline v1
