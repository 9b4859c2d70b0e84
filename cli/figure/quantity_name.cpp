#include "figure/quantity_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace sinew::cli {
namespace {

struct Name {
  std::string_view column, words;
  std::string_view quantity = {};  ///< of all that differ by a number only
};

/// In the language of `formula`. A number after it, as in `tension_2`, follows.
constexpr std::array stems{
    Name{"tendon", "Tendon", "Tendon length"},
    Name{"tension", "Tension", "Tension"},
    Name{"end_tension", "Tension at the end", "Tension"},
    Name{"change", "Tendon change", "Tendon change"},
    Name{"theta", "θ", "Angle"},
    Name{"beta", "β", "Angle"},
    Name{"curvature", "Curvature", "Curvature"},
    Name{"slide", "Slide", "Slide"},
    Name{"length", "Length", "Length"},
    Name{"extension", "Extension", "Extension"},
};

constexpr std::array names{
    Name{"phi", "φ"},
    Name{"condition", "Condition number"},
    Name{"condition_homogenised", "Condition number (homogenised)"},
    Name{"inverse_condition", "1 / condition number"},
    Name{"inverse_condition_homogenised", "1 / condition number (homogenised)"},
    Name{"determinant", "det J"},
    Name{"closure_error", "Closure error"},
    Name{"unstable_directions", "Unstable directions"},
    Name{"potential", "Potential energy"},
    Name{"residual", "Residual"},
    Name{"parameter", "Parameter"},
    Name{"reachable", "Reachable"},
    Name{"type_1", "Legs at a type I singularity"},
    Name{"type_2", "Type II singularity"},
    Name{"sample", "Sample"},
    Name{"status", "Status"},
    Name{"kappa", "κ"},
    Name{"motor_work", "Work of the motors"},
    Name{"friction_loss", "Lost by friction"},
};

/// Of a pose: the platform's, or a serial robot's tip.
constexpr std::array pose_names{
    Name{"x", "x_p"},  Name{"y", "y_p"},  Name{"z", "z_p"},  Name{"rx", "r_x"},
    Name{"ry", "r_y"}, Name{"rz", "r_z"}, Name{"fx", "f_x"}, Name{"fy", "f_y"},
    Name{"fz", "f_z"}, Name{"mx", "m_x"}, Name{"my", "m_y"}, Name{"mz", "m_z"},
};

constexpr std::array quantities{Name{"m", "Length"},   Name{"rad", "Angle"},     Name{"N", "Force"},
                                Name{"N m", "Moment"}, Name{"1/m", "Curvature"}, Name{"J", "Energy"}};

template <class Table>
const Name* find(const Table& table, std::string_view column) {
  const auto found = std::ranges::find(table, column, &Name::column);
  return found == table.end() ? nullptr : &*found;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.size() < 4 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// `legs[1].tension_2`, or `sections[1].tendons[0].tension`, taken apart.
struct Parts {
  std::string_view stem;    ///< `tension`
  std::string_view number;  ///< `2`; empty: none
  int leg = 0;              ///< 2, from one; 0: none
  int section = 0, tendon = 0;
};

/// Takes `legs[1].` from the beginning; its index from one, 0 where the text begins otherwise.
int take_place(std::string_view& column, std::string_view prefix) {
  if (!column.starts_with(prefix)) return 0;
  const std::size_t end = column.find("].");
  if (end == std::string_view::npos) return 0;
  const std::string_view index = column.substr(prefix.size(), end - prefix.size());
  if (!is_number(index)) return 0;
  int number = 0;
  for (const char c : index) number = 10 * number + (c - '0');
  column.remove_prefix(end + 2);
  return number + 1;
}

Parts parts_of(std::string_view column) {
  Parts parts{column, {}};
  parts.leg = take_place(parts.stem, "legs[");
  parts.section = take_place(parts.stem, "sections[");
  if (parts.section > 0) parts.tendon = take_place(parts.stem, "tendons[");
  const std::size_t mark = parts.stem.rfind('_');
  if (mark != std::string_view::npos && is_number(parts.stem.substr(mark + 1))) {
    parts.number = parts.stem.substr(mark + 1);
    parts.stem = parts.stem.substr(0, mark);
  }
  return parts;
}

}  // namespace

bool is_of_sinew(const Table& table) {
  return std::ranges::any_of(table.comments, [](const std::string& comment) {
    return comment.starts_with("sinew ") || comment.starts_with("sinew_version:") ||
           comment.starts_with("status:");
  });
}

Text quantity_name(std::string_view column, bool is_ours) {
  if (const Name* name = find(names, column)) return formula(name->words);
  if (const Name* name = find(pose_names, column); name && is_ours) return formula(name->words);
  const Parts parts = parts_of(column);
  if (const Name* name = find(stems, parts.stem)) {
    const bool is_symbol = !std::isalpha(static_cast<unsigned char>(name->words.front()));
    Text text = formula(name->words);
    if (!parts.number.empty())
      text += is_symbol ? Text(parts.number, Text::Style::subscript) : Text(fmt::format(" {}", parts.number));
    if (parts.leg > 0) text += fmt::format(" of leg {}", parts.leg);
    if (parts.tendon > 0) text += fmt::format(", tendon {} of section {}", parts.tendon, parts.section);
    return text;
  }
  const bool has_index = is_ours && column.size() > 1 && column.size() < 4 &&
                         std::isalpha(static_cast<unsigned char>(column.front())) &&
                         is_number(column.substr(1));
  if (has_index)  // e1, L2
    return Text(column.substr(0, 1), Text::Style::italic) + Text(column.substr(1), Text::Style::subscript);
  return column;
}

Text common_name(const std::vector<const Column*>& columns) {
  const Name* first = nullptr;
  bool is_one = !columns.empty();
  for (const Column* column : columns) {
    const Name* name = find(stems, parts_of(column->name).stem);
    if (column == columns.front()) first = name;
    is_one = is_one && name != nullptr && name == first;
  }
  if (is_one) return formula(first->quantity);
  const bool has_one_unit = std::ranges::all_of(
      columns, [&](const Column* column) { return column->unit == columns.front()->unit; });
  const Name* quantity = columns.empty() || !has_one_unit ? nullptr : find(quantities, columns[0]->unit);
  return quantity ? formula(quantity->words) : Text();
}

Text place_name(std::string_view column, std::string_view value, std::string_view unit, bool is_ours) {
  std::string number(value);
  if (number.starts_with('-')) number = "−" + number.substr(1);
  Text text = quantity_name(column, is_ours) + " = " + number;
  if (!unit.empty()) text += (unit == "deg" ? Text() : Text(" ")) + unit_text(unit);
  return text;
}

}  // namespace sinew::cli
