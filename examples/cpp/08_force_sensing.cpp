/// The load on a hexapod's platform from the axial forces of its six rods, as load cells measure them.
#include <cmath>
#include <cstdio>

#include "sinew/sinew.hpp"

int main() {
  const auto robot = sinew::load("hexapod").value();
  sinew::Workspace work(robot);
  const double lengths[] = {0.410, 0.410, 0.405, 0.405, 0.405, 0.405};
  const double axial[] = {0.1, -0.2, 0.1, 0, 0.1, 0};  // [N], pull > 0
  const double deviations[] = {0.01, 0.01, 0.01, 0.01, 0.01, 0.01};

  const auto sensed = sinew::sense_wrench(robot, lengths, axial, deviations, {}, work);
  if (!sensed.report.ok()) return std::puts(sinew::to_string(sensed.report).c_str()), 3;
  const char* const names[] = {"fx [N]  ", "fy [N]  ", "fz [N]  ", "mx [N m]", "my [N m]", "mz [N m]"};
  for (int i = 0; i < 6; ++i)
    std::printf("%s %9.5f +- %.5f\n", names[i], sensed.wrench[i],
                std::sqrt(sensed.covariance[std::size_t(7 * i)]));
}

// Prints:
//   fx [N]    -0.28583 +- 0.00336
//   fy [N]    -0.03158 +- 0.00320
//   fz [N]     0.10000 +- 0.02449
//   mx [N m]  -0.01445 +- 0.00155
//   my [N m]   0.05585 +- 0.00156
//   mz [N m]  -0.00804 +- 0.00037
