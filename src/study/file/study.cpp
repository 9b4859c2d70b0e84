#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

std::size_t Study::reduced_samples() const {
  std::size_t product = 1;
  for (std::size_t a = axes.size() - reduced_axes; a < axes.size(); ++a) product *= axes[a].values.size();
  return product;
}

const std::string& Study::column_name(std::size_t column) const {
  if (column < axes.size()) return axes[column].name;
  if (column < variable_count()) return derived[column - axes.size()].name;
  return outputs[column - variable_count()].name;
}

const std::string& Study::column_unit(std::size_t column) const {
  if (column < axes.size()) return axes[column].unit;
  if (column < variable_count()) return derived[column - axes.size()].unit;
  return outputs[column - variable_count()].unit;
}

std::vector<std::string> Study::variable_names() const {
  std::vector<std::string> names;
  for (std::size_t v = 0; v < variable_count(); ++v) names.push_back(column_name(v));
  return names;
}

std::optional<std::size_t> Study::find_variable(std::string_view name) const {
  for (std::size_t v = 0; v < variable_count(); ++v)
    if (column_name(v) == name) return v;
  return {};
}

}  // namespace sinew::inline v1
