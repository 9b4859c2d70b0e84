/// Rows of a bounded least squares problem from the Jacobian of a serial robot's tip.
#include "kinematics/serial/tip_rows.hpp"

namespace sinew::inline v1 {
namespace {

/// Columns from per bend to per unknown.
void to_unknowns(const SerialRobot& robot, std::span<const Bend> bends, BoundedStep& system) {
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const std::size_t j = 2 * m;
    const double share = 1 / turns(robot.sections[m]);
    const Bend along = robot.sections[m].is_twin() ? Bend(share, 0) : bend_direction(bends[m]);
    for (int i = 0; i < system.rows; ++i) {
      double* const a = system.A[i] + j;
      const double x = a[0], y = a[1];
      a[0] = along.x() * x + along.y() * y;
      a[1] = along.x() * y - along.y() * x;
    }
  }
}

/// Columns of extensions behind those of bends.
void append_extensions(const SerialRobot& robot, const SerialWorkspace& work, BoundedStep& system) {
  const int first = 2 * static_cast<int>(work.sections.size());
  for (int i = 0; i < system.rows; ++i)
    for (int j = first; j < system.columns; ++j) {
      const auto m = static_cast<std::size_t>(j - first);
      const bool varies = m < robot.sections.size() && robot.sections[m].is_extensible();
      system.A[i][j] = i < 3 && varies ? work.extension_jacobians[m].tip[i] : 0;
    }
}

}  // namespace

/// Even, as the solver wants them.
int unknowns(const SerialRobot& robot) {
  const int sections = robot.section_count();
  return 2 * sections + (robot.is_extensible() ? sections + sections % 2 : 0);
}

Room room(const Section& section, const Bend& bend) {
  const double limit = section.limit, size = section.is_twin() ? 0 : std::sqrt(squared_norm(bend));
  const double x = section.is_twin() ? bend.x() : size, y = section.is_twin() ? bend.y() : 0;
  const double count = turns(section);
  return {{std::min(0.0, count * (-limit - x)), std::min(0.0, count * (-limit - y))},
          {std::max(0.0, count * (limit - x)), std::max(0.0, count * (limit - y))}};
}

Bend bend_change(const Section& section, const Bend& bend, double first, double second) {
  if (section.is_twin()) return Bend(first, second) / turns(section);
  const Bend along = bend_direction(bend);
  return first * along + second * Bend(-along.y(), along.x());
}

void tip_rows(const SerialRobot& robot, std::span<const Bend> bends, const SerialWorkspace& work,
              double length, const Vec3<double>& shift, const Vec3<double>& turn, BoundedStep& system) {
  const std::size_t columns = 2 * bends.size();
  const double* const J = work.J.data();
  for (int i = 0; i < 3; ++i) {
    system.r[i] = shift[i] / length;
    for (std::size_t j = 0; j < columns; ++j)
      system.A[i][j] = J[static_cast<std::size_t>(i) * columns + j] / length;
  }
  const double* const T = J + 3 * columns;
  for (int i = 3; i < system.rows; ++i) {
    Vec3<double> axis(i == 3, i == 4, i == 5);
    if (system.rows == 5) axis = work.ends.back().rotate(axis);
    system.r[i] = dot(axis, turn);
    for (std::size_t j = 0; j < columns; ++j)
      system.A[i][j] = axis[0] * T[j] + axis[1] * T[j + columns] + axis[2] * T[j + 2 * columns];
  }
  to_unknowns(robot, bends, system);
  append_extensions(robot, work, system);
}

}  // namespace sinew::inline v1
