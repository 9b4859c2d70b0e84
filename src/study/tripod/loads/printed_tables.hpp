/// @file printed_tables.hpp
/// Tables 1 and 2 of [3PFS]: relative RMS error between loaded and unloaded poses of the 3PFS, and what these
/// numbers say by themselves. Theory: docs/theory/tripod_loads.md
#pragma once
#include <array>
#include <cstddef>

namespace sinew::inline v1::tripod {

/// A load on the platform, constant in the fixed frame; as the studies' axis `kind` counts them.
enum class Load { force_z, moment_x, moment_y };
inline constexpr std::array loads{Load::force_z, Load::moment_x, Load::moment_y};
inline constexpr std::size_t load_steps = 4;

const char* name_of(Load load);  ///< `F_z`
const char* unit_of(Load load);
/// Of a step from 0 (none) to `load_steps`, [N] downwards or [N m].
double value_of(Load load, std::size_t step);

/// Columns of the tables, and of our studies.
inline constexpr std::array variables{"x", "y", "z", "e3"};

/// Relative RMS [%] by load, step (from 1 on), variable.
using RmsCells = std::array<std::array<std::array<double, variables.size()>, load_steps>, loads.size()>;

struct PrintedTable {
  const char* stem;  ///< of its files
  RmsCells cells;
};

/// As printed, but not under the headings z_p, e_3, x_p, y_p: columns one and two are a vector's components,
/// three and four are not. 3 mm.
inline constexpr PrintedTable table_1{"table1",
                                      {{{{{0.2994, 0.3316, 0.0587, 0.1847},
                                          {0.6567, 0.7274, 0.1250, 0.3962},
                                          {1.0903, 1.2076, 0.2019, 0.6465},
                                          {1.6276, 1.8027, 0.2950, 0.9569}}},
                                        {{{1.0801, 2.9173, 0.0884, 2.1147},
                                          {2.1333, 6.0013, 0.1852, 4.2585},
                                          {3.1661, 9.2941, 0.3330, 6.5019},
                                          {4.1868, 12.8431, 0.5599, 8.9256}}},
                                        {{{2.5773, 1.2163, 0.1080, 2.1356},
                                          {5.1938, 2.4509, 0.2622, 4.3486},
                                          {7.8955, 3.7245, 0.5055, 6.7339},
                                          {10.7512, 5.0638, 0.9096, 9.4405}}}}}};

/// The same of rods of 4 mm.
inline constexpr PrintedTable table_2{"table2",
                                      {{{{{0.0348, 0.0385, 0.0070, 0.0219},
                                          {0.0702, 0.0778, 0.0141, 0.0441},
                                          {0.1065, 0.1179, 0.0213, 0.0667},
                                          {0.1434, 0.1589, 0.0286, 0.0896}}},
                                        {{{0.1367, 0.3571, 0.0122, 0.2652},
                                          {0.2730, 0.7162, 0.0239, 0.5300},
                                          {0.4087, 1.0775, 0.0352, 0.7943},
                                          {0.5440, 1.4410, 0.0461, 1.0585}}},
                                        {{{0.3215, 0.1517, 0.0125, 0.2655},
                                          {0.6431, 0.3035, 0.0251, 0.5312},
                                          {0.9649, 0.4554, 0.0379, 0.7972},
                                          {1.2868, 0.6073, 0.0510, 1.0636}}}}}};

/// A row of the tables, `variable` an index of `variables`.
double cell(const RmsCells& cells, Load load, std::size_t step, std::size_t variable);

/// RMS over load where the load goes to 0: load over RMS extrapolated by a parabola [% per N or N m].
double linear_limit(const RmsCells& cells, Load load, std::size_t variable);

/// The load at which the straight line through load over RMS is 0, where RMS would be infinite [N or N m].
double pole(const RmsCells& cells, Load load, std::size_t variable);

}  // namespace sinew::inline v1::tripod
