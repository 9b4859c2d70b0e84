/// Poses of a serial robot's sections and the Jacobian of its tip.
#include <algorithm>
#include <cmath>

#include "sinew/kinematics/serial.hpp"

#include "link/bent_motion.hpp"
#include "robot/arms/section_motion.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

const SE3<double> nowhere{Vec3<double>::Constant(not_a_number), SO3<double>::identity()};

}  // namespace

void section_ends(std::span<const Bend> bends, SerialWorkspace& work) {
  if (!work.fits(bends)) return void(std::ranges::fill(work.ends, nowhere));
  BentPose<double> end;
  for (std::size_t m = 0; m < bends.size(); ++m) {
    end = end.then(section_pose(work.sections[m], bends[m]));
    work.ends[m] = end.rigid();
  }
}

/// A section's columns are first those of a point of the tip that is at the base's origin, and are carried to
/// the tip when it is known where that is.
void tip_motion(std::span<const Bend> bends, SerialWorkspace& work) {
  if (!work.fits(bends)) {
    std::ranges::fill(work.J, not_a_number);
    return void(std::ranges::fill(work.ends, nowhere));
  }
  const std::size_t columns = 2 * bends.size();
  double* const J = work.J.data();
  BentPose<double> end;
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const BentMotion<double> section = section_motion(work.sections[m], bends[m]);
    const detail::Turn<double> base(end.w, end.v);
    double arm[3];
    base.apply(section.pose.p, arm);
    end = end.then(section.pose, arm);
    work.ends[m] = end.rigid();
    detail::Abreast<double> shift[3], turn[3];
    base.apply(section.shift, shift);
    base.apply(section.turn, turn);
    const double back[3] = {-end.p[0], -end.p[1], -end.p[2]};
    for (int i = 0; i < 3; ++i) {
      detail::carried(shift[i], turn, back, i).store(J + static_cast<std::size_t>(i) * columns + 2 * m);
      turn[i].store(J + static_cast<std::size_t>(i + 3) * columns + 2 * m);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3, l = (i + 2) % 3;
    const double *turn_k = J + (3 + k) * columns, *turn_l = J + (3 + l) * columns;
    for (std::size_t j = 0; j < columns; ++j)
      J[i * columns + j] += turn_k[j] * end.p[l] - turn_l[j] * end.p[k];
  }
}

std::optional<Mat<double, 2, 2>> tip_steering(const SerialWorkspace& work) {
  const SO3<double>& R = work.ends.back().R;
  const MatrixView J = work.jacobian();
  Mat<double, 2, 2> turn;  // of the axis towards x and y, per bend rate: omega × z
  for (int j = 0; j < 2; ++j) {
    const Vec3<double> rate = R.rotate_back(Vec3<double>(J.col(J.cols() - 2 + j).tail<3>()));
    turn.col(j) << rate.y(), -rate.x();
  }
  constexpr double least = 1e-6;
  const double determinant = turn.determinant();
  if (!(std::abs(determinant) > least * turn.squaredNorm())) return {};
  Mat<double, 2, 2> steering;
  steering << turn(1, 1), -turn(0, 1), -turn(1, 0), turn(0, 0);
  return Mat<double, 2, 2>(steering / determinant);
}

void extension_motion(std::span<const Bend> bends, kernel::Model model, SerialWorkspace& work) {
  if (!work.fits(bends))
    return void(std::ranges::fill(work.extension_jacobians, ExtensionMotion{nowhere.p, not_a_number}));
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const Vec3<double> own = work.sections[m].extension_motion(bends[m]);
    const kernel::Bend<double> bend{bends[m].x(), bends[m].y()};
    work.extension_jacobians[m] = {m == 0 ? own : work.ends[m - 1].rotate(own),
                                   kernel::chord_share(model, work.maps[m], bend)};
  }
}

}  // namespace sinew::inline v1
