#include "study/tripod/loads/loads.hpp"

#include <algorithm>
#include <cmath>

#include "study/tripod/tilt_plane.hpp"

namespace sinew::inline v1::tripod {

std::vector<std::size_t> rows_of(const Swept& study, const LoadCase& at) {
  const auto &rods = study["rods"], &kind = study["kind"], &step = study["step"];
  const double wanted_rods = static_cast<double>(at.rods), wanted_kind = static_cast<double>(at.load),
               wanted_step = static_cast<double>(at.step);
  return rows_where(study, [&](std::size_t k) {
    return rods[k] == wanted_rods && kind[k] == wanted_kind && step[k] == wanted_step;
  });
}

std::vector<double> LoadedPairs::change() const {
  std::vector<double> out;
  out.reserve(loaded.size());
  for (std::size_t k = 0; k < loaded.size(); ++k) out.push_back(loaded[k] - unloaded[k]);
  return out;
}

LoadedPairs pairs_of(const Swept& study, const LoadCase& at, std::string_view variable) {
  const LoadCase without{at.rods, at.load, 0};
  return {at_rows(study[variable], rows_of(study, without)), at_rows(study[variable], rows_of(study, at))};
}

std::vector<std::size_t> middle_layer(const Swept& study) {
  const std::vector<std::size_t> all = rows_of(study, {Rods::thin, Load::force_z, 0});
  const auto &L1 = study["L1"], &L2 = study["L2"], &L3 = study["L3"];
  const auto [low, high] = std::ranges::minmax(L1);
  const double sum = 1.5 * (low + high), rounding = 1e-9 * sum;
  std::vector<std::size_t> layer;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (std::abs(L1[all[k]] + L2[all[k]] + L3[all[k]] - sum) < rounding) layer.push_back(k);
  return layer;
}

LoadedPairs at_rows(const LoadedPairs& pairs, std::span<const std::size_t> rows) {
  return {at_rows(pairs.unloaded, rows), at_rows(pairs.loaded, rows)};
}

double relative_rms(const LoadedPairs& pairs) {
  const auto [low, high] = range_of(pairs.unloaded);
  return 100 * root_mean_square(pairs.change()) / (high - low);
}

RmsCells relative_rms(const Swept& study, Rods rods) {
  RmsCells cells{};
  for (const Load load : loads)
    for (std::size_t step = 1; step <= load_steps; ++step)
      for (std::size_t v = 0; v < variables.size(); ++v)
        cells[static_cast<std::size_t>(load)][step - 1][v] =
            relative_rms(pairs_of(study, {rods, load, step}, variables[v]));
  return cells;
}

}  // namespace sinew::inline v1::tripod
