#include <fmt/format.h>

#include <algorithm>

#include "analysis/identify/quantities.hpp"
#include "robot/arms/arm_weight.hpp"

namespace sinew::inline v1 {

std::string usual_fit(const MeasuredArm& arm, const MeasuredRows& rows, ArmModel model) {
  std::string names = "sections.bending,sections.angle,sections.compliance";
  if (model != ArmModel::prb) names += ",sections.curvature";
  names += ",tendons.offset,tendons.toe";
  if (has_weight(arm.arm)) names += ",gravity";
  names += ",marker,base,tilt.x,tilt.y";
  if (!rows.time.empty()) names += ",lag";
  return names;
}

Expected<std::vector<FitParameter>> fit_parameters(const MeasuredArm& given, std::string_view names) {
  using namespace identification;
  const MeasuredArm arm = completed(given);
  std::vector<FitParameter> result;
  while (!names.empty()) {
    const std::size_t comma = names.find(',');
    std::string_view name = names.substr(0, comma);
    names = comma == std::string_view::npos ? std::string_view{} : names.substr(comma + 1);
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    std::string_view of;  // whom there is one for
    for (std::string_view owner : {"sections", "tendons", "passages"})
      if (name.starts_with(owner) && name.size() > owner.size() && name[owner.size()] == '.') {
        of = owner;
        name.remove_prefix(owner.size() + 1);
      }
    std::vector<const QuantityWords*> found;
    for (const QuantityWords& words : all_quantities())
      if (words.name == name) found.push_back(&words);
    if (found.empty())
      for (const QuantityWords& words : all_quantities())
        if (words.name.size() == name.size() + 2 && words.name.starts_with(name) &&
            words.name[name.size()] == '.')
          found.push_back(&words);
    if (found.empty() && name == "friction")
      return failure(
          "not_available", name,
          "rows are compared as if tendons slid freely: friction depends on the way that they came, "
          "which rows at rest do not tell. What motors lose when they turn back is play, and "
          "what comes late is lag; fit these.");
    if (found.empty()) {
      std::string known;
      for (const QuantityWords& words : all_quantities())
        known += (known.empty() ? "" : ", ") + std::string(words.name);
      return failure("unknown_name", name, fmt::format("no quantity of an arm; there are {}.", known));
    }
    bool is_double = false;
    for (const QuantityWords* words : found) {
      const auto one = [&](std::string label, int section, int tendon, std::vector<ArmField> fields) {
        if (fields.empty()) fields.push_back({words->quantity, section, tendon});
        FitParameter p{.name = std::move(label),
                       .unit = std::string(words->unit),
                       .fields = std::move(fields),
                       .is_factor = words->is_factor,
                       .lower = words->lower,
                       .upper = words->upper,
                       .prior = words->prior};
        const bool is_gravity = words->unit == "m/s^2";
        if (!p.is_factor && (p.lower == 0 || is_gravity)) {  // bounds of the number, not of its change
          const double value = value_of(arm, p);
          p.lower = std::min(p.lower - value, 0.0);
          p.upper = std::max(p.upper - value, 0.0);
        }
        const auto has_name = [&](const FitParameter& other) { return other.name == p.name; };
        is_double = is_double || std::ranges::any_of(result, has_name);
        result.push_back(std::move(p));
      };
      const std::string base(words->name);
      if (of.empty()) {
        one(base, -1, -1, {});
      } else if (of == "sections" && words->owner != Owner::arm) {
        for (int m = 0; m < section_count(arm); ++m) {
          std::vector<ArmField> fields;
          if (words->owner != Owner::section)  // the tendons that end there
            for (int i = 0; i < tendon_count(arm); ++i)
              if (arm.arm.tendons[at(i)].section() == m) fields.push_back({words->quantity, -1, i});
          if (words->owner != Owner::section && fields.empty()) continue;
          one(fmt::format("sections[{}].{}", m, base), m, -1, std::move(fields));
        }
      } else if (of == "tendons" && (words->owner == Owner::tendon || words->owner == Owner::passage)) {
        for (int i = 0; i < tendon_count(arm); ++i) one(fmt::format("tendons[{}].{}", i, base), -1, i, {});
      } else if (of == "passages" && words->owner == Owner::passage) {
        for (int i = 0; i < tendon_count(arm); ++i)
          for (int m = 0; m < arm.arm.tendons[at(i)].section(); ++m)
            one(fmt::format("tendons[{}].sections[{}].{}", i, m, base), m, i, {});
      } else {
        return failure("not_available", name, fmt::format("{} have no {} of their own.", of, base));
      }
    }
    if (is_double)
      return failure("duplicate_name", name, "is named twice; the rows could not tell which; keep one.");
  }
  return result;
}

}  // namespace sinew::inline v1
