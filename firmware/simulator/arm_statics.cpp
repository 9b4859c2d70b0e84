#include "simulator/arm_statics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/limits.hpp"
#include "math/linalg.hpp"

namespace sinew::firmware {
namespace {

constexpr int max_iterations = 60;
constexpr double small_step = 1e-9;  ///< [rad] that ends an iteration
constexpr int max_passes = 8;
constexpr double small_friction = 1e-5;  ///< [N] that it may still change by
constexpr double rounding = 1e-14;       ///< [J] of an energy

/// A spring that slides from where its force is `most`: a quadratic, then linear. Huber's function.
double rubbing_energy(double stiffness, double most, double stretch) {
  const double force = stiffness * std::abs(stretch);
  return force <= most ? 0.5 * force * std::abs(stretch)
                       : most * std::abs(stretch) - 0.5 * most * most / stiffness;
}

}  // namespace

ArmStatics::ArmStatics(const SerialRobot& robot, const ArmMaterial& material)
    : bends(robot.sections.size(), Bend::Zero()),
      work_(robot),
      material_(material),
      tried_(bends),
      before_(bends) {
  if (robot.section_count() > max_sections) throw std::runtime_error("an arm has twelve sections at most");
  const TendonStretch stretch = robot.stretch.value_or(TendonStretch{material.stiffness, material.outside});
  double length = 0;
  for (const Section& section : robot.sections) {
    length += section.length();
    const double limit = std::isfinite(section.limit) ? section.limit : 1.0;
    bending_.push_back(material.tension_at_limit * section.map().gain / limit);
    most_.push_back(material.rest_at * limit);
    for (int i = 0; i < section.tendons; ++i) {
      inner_.push_back(stretch.stiffness / length);
      outer_.push_back(stretch.outside > 0 ? stretch.stiffness / stretch.outside : 1e3 * inner_.back());
      rubs_.push_back(material.friction * static_cast<double>(bending_.size()));
      Tendon tendon;
      tendon.stiffness = 1 / (1 / inner_.back() + 1 / outer_.back());
      tendons.push_back(tendon);
    }
  }
  const std::size_t n = 2 * bends.size();
  gradient_.resize(n);
  newton_.resize(n);
  hessian_.resize(n * n);
  slopes_.resize(tendons.size());
  stiffness_.resize(tendons.size());
}

std::span<const double> ArmStatics::ways(std::span<const Bend> of) {
  tendon_changes(of, kernel::Model::exact, work_);
  return work_.changes;
}

double ArmStatics::energy_of_bending(std::span<const Bend> of, std::span<double> gradient) const {
  double energy = 0;
  for (std::size_t m = 0; m < of.size(); ++m)
    for (int axis = 0; axis < 2; ++axis) {
      const double x = of[m][axis], beyond = std::max(std::abs(x) - most_[m], 0.0);
      const double contact = material_.contact_stiffness * bending_[m];
      energy += 0.5 * bending_[m] * x * x + 0.5 * contact * beyond * beyond;
      if (!gradient.empty())
        gradient[2 * m + static_cast<std::size_t>(axis)] =
            bending_[m] * x + contact * std::copysign(beyond, x);
    }
  return energy;
}

/// With the slopes and stiffnesses of all tendons.
double ArmStatics::energy_of_tendons(std::span<const Bend> of) {
  double energy = 0;
  ways(of);
  for (std::size_t i = 0; i < tendons.size(); ++i) {
    Tendon& tendon = tendons[i];
    slopes_[i] = stiffness_[i] = tendon.tension = tendon.friction_now = 0;
    if (tendon.is_cut) continue;
    const double stretch = std::max(work_.changes[i] - tendon.paid_out, 0.0), k = tendon.stiffness;
    const double rubbed = work_.changes[i] - tendon.rubs_from;
    tendon.tension = k * stretch;
    tendon.friction_now = std::clamp(k * rubbed, -tendon.friction, tendon.friction);
    energy += 0.5 * k * stretch * stretch + rubbing_energy(k, tendon.friction, rubbed);
    slopes_[i] = tendon.tension + tendon.friction_now;
    stiffness_[i] = (stretch > 0 ? k : 0) + (std::abs(k * rubbed) < tendon.friction ? k : 0);
  }
  return energy;
}

/// After `energy_of_tendons` and `tendon_rates` of the same bends.
void ArmStatics::add_gradient_of_tendons(std::span<double> gradient) const {
  const std::size_t n = gradient.size();
  for (std::size_t i = 0; i < tendons.size(); ++i)
    if (slopes_[i] != 0)
      for (std::size_t k = 0; k < n; ++k) gradient[k] += slopes_[i] * work_.K[i * n + k];
}

double ArmStatics::energy(std::span<const Bend> of, std::span<double> gradient) {
  const double energy = energy_of_bending(of, gradient) + energy_of_tendons(of);
  if (!gradient.empty()) {
    tendon_rates(of, kernel::Model::exact, work_);
    add_gradient_of_tendons(gradient);
  }
  return energy;
}

/// Without what the curvature of the tendons' ways adds: a few hundredths of the bending stiffness, which
/// costs an iteration and keeps the matrix positive.
void ArmStatics::make_hessian(std::span<const Bend> of) {
  const std::size_t n = gradient_.size();
  std::ranges::fill(hessian_, 0.0);
  for (std::size_t i = 0; i < tendons.size(); ++i) {
    if (stiffness_[i] == 0) continue;
    const double* const rate = work_.K.data() + i * n;
    for (std::size_t row = 0; row < n; ++row) {
      const double scaled = stiffness_[i] * rate[row];
      if (scaled == 0) break;  // a tendon passes the first sections
      for (std::size_t column = 0; column <= row; ++column)
        hessian_[row * n + column] += scaled * rate[column];
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    const std::size_t m = row / 2;
    const bool touches = std::abs(of[m][static_cast<Eigen::Index>(row % 2)]) > most_[m];
    hessian_[row * n + row] += bending_[m] * (touches ? 1 + material_.contact_stiffness : 1);
    for (std::size_t column = 0; column < row; ++column)
      hessian_[column * n + row] = hessian_[row * n + column];
  }
}

/// Whether there is another one to take.
bool ArmStatics::step() {
  const auto n = static_cast<Eigen::Index>(gradient_.size());
  const double here = energy(bends, gradient_);
  make_hessian(bends);
  if (!solve(MatrixView(hessian_.data(), n, n), MatrixView(gradient_.data(), n, 1), newton_)) return false;
  double largest = 0, slope = 0;
  for (std::size_t k = 0; k < newton_.size(); ++k) {
    largest = std::max(largest, std::abs(newton_[k]));
    slope += newton_[k] * gradient_[k];
  }
  if (largest < small_step) return false;
  double share = std::min(1.0, 0.5 / largest);  // half a radian at most
  for (int halved = 0; halved < 30; ++halved, share *= 0.5) {
    for (std::size_t m = 0; m < bends.size(); ++m)
      tried_[m] = bends[m] - share * Bend(newton_[2 * m], newton_[2 * m + 1]);
    if (energy(tried_) > here - 1e-4 * share * slope + rounding) continue;
    bends = tried_;
    return share * largest >= small_step;
  }
  return false;
}

/// Friction is what tension makes it. Whether that has changed much.
bool ArmStatics::update_friction() {
  bool has_changed = false;
  energy_of_tendons(bends);
  for (std::size_t i = 0; i < tendons.size(); ++i) {
    const double most = rubs_[i] * tendons[i].tension;
    has_changed = has_changed || std::abs(most - tendons[i].friction) > small_friction;
    tendons[i].friction = most;
  }
  return has_changed;
}

/// Tendons that have slid rub from where they are.
void ArmStatics::slide() {
  energy_of_tendons(bends);
  for (std::size_t i = 0; i < tendons.size(); ++i)
    tendons[i].rubs_from = work_.changes[i] - tendons[i].friction_now / tendons[i].stiffness;
}

bool ArmStatics::settle() {
  before_ = bends;
  iterations_ = 0;
  bool has_changed = true;
  // Each pass has the friction of the one before, which is off by a few hundredths of what it was off before.
  for (int pass = 0; pass < max_passes && has_changed; ++pass) {
    for (int i = 0; i < max_iterations && step(); ++i) ++iterations_;
    has_changed = update_friction();
  }
  slide();
  double moved = 0;
  for (std::size_t m = 0; m < bends.size(); ++m)
    moved = std::max(moved, (bends[m] - before_[m]).cwiseAbs().maxCoeff());
  return has_changed || moved > small_step;
}

}  // namespace sinew::firmware
