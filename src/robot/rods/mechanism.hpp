/// @file mechanism.hpp
/// A platform on a group of rods and on legs that close, if there are any: the equations of the rods,
/// projected onto the motions that the closing legs leave free, so that Newton's method sees six equations
/// as ever. Theory: docs/theory/mixed_robot.md
#pragma once
#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "base/at.hpp"
#include "base/limits.hpp"
#include "robot/limbs/kinematic_group.hpp"
#include "robot/rods/rod_group.hpp"
#include "solve/contraction.hpp"

namespace sinew::inline v1 {

/// Without closing legs it does what `Rods` does.
/// @tparam Rods a group of rods: ElasticaSystem, TangentSystem or GeneralSystem
template <class Rods>
class Mechanism final : public Rods {
 public:
  using Wrench = Vec<double, 6>;
  using Twist = Vec<double, 6>;

  explicit Mechanism(const SpatialRobot& robot)  ///< allocates
      : Rods(legs_of<RodLeg>(robot)),
        robot_(robot),
        values_(at(robot.total.input), 0.0),
        coordinates_(closes() ? at(robot.total.coordinate) : 0, 0.0),
        K_(at(robot.total.row * robot.total.input), 0.0),
        rank_(std::min(group().rows(), 6)) {
    robot_.for_each_leg([&]<class L>(const L&, const LegPlace& place, int i) {
      if constexpr (BearsLoad<L>) return leg_of_.push_back(i);
      ++closing_legs_;
      for (int k = 0; k < L::inputs; ++k) this->input_of_.push_back(place.input + k);
    });
  }

  bool closes() const override { return group().rows() > 0; }
  int undriven() const override { return std::max(rank_ - (Rods::feeds() - Rods::limbs()), 0); }
  int leg_of(int rod) const override { return leg_of_[at(rod)]; }

  void save(LimbState& to) const override {
    Rods::save(to);
    to.put(std::span<const double>(values_));
  }
  void restore(const LimbState& from) override {
    Rods::restore(from);
    from.get_last(std::span<double>(values_));
  }

  /// @name What is held: lengths of the rods, then what the closing legs are driven by
  /// @{
  double held(int feed) const override { return is_rod(feed) ? Rods::length(feed) : value_of(feed); }
  void set_feed(int feed, double value) override {
    if (is_rod(feed))
      Rods::set_feed(feed, value);
    else
      values_[at(Rods::input_of(feed))] = value;
  }
  bool in_domain(int feed, double value) const override {
    return is_rod(feed) ? Rods::in_domain(feed, value) : group().in_domain(Rods::input_of(feed), value);
  }
  void set_inputs(Numbers inputs) override {
    Rods::set_inputs(inputs);
    std::ranges::copy(inputs, values_.begin());
  }
  /// @}

  /// @name Newton's method
  /// @{
  bool rest_at(const SE3<double>& platform) override {
    return (!closes() || group().close_at(platform, values_)) && Rods::rest_at(platform);
  }
  bool solve_warm(Report& report) override {
    const auto advance = [&](bool fresh) {
      move(step(fresh));
      return true;
    };
    return contract_with_kept_factors([&] { return evaluate(false); }, [&] { return linearise(); }, advance,
                                      rod_tolerance, evaluate(false), report.iterations, report.residual);
  }
  double evaluate(bool from_scratch = true) override {
    const double own = Rods::evaluate(from_scratch);
    if (!closes()) return own;
    group().to_coordinates(values_, coordinates_);
    group().evaluate(Rods::platform(), coordinates_, {J_, K_, s_});
    scale_rows();
    if (!lines_.allFinite()) return std::numeric_limits<double>::quiet_NaN();
    project();
    const Wrench left = free_ * scaled(Rods::wrench_residual());
    double force = 0, length = 0;
    for (int k = 0; k < Rods::limbs(); ++k) {
      force = std::max(force, Rods::stiffness(k) / (Rods::length(k) * Rods::length(k)));
      length = std::max(length, Rods::length(k));
    }
    const double gap = gap_.template lpNorm<Eigen::Infinity>() / length;
    const double error = std::max({Rods::limb_error(), gap, left.template lpNorm<Eigen::Infinity>() / force});
    return std::isnan(gap + left.sum()) ? std::numeric_limits<double>::quiet_NaN() : error;
  }

  bool linearise() override {
    const bool is_held = Rods::linearise();
    if (!closes()) return is_held;  // else the rods alone need not hold the platform
    // the closing legs push with what is missing, along their rows
    const Wrench missing = scaled(Rods::wrench_residual());
    force_ = -(inverse_.transpose() * missing).cwiseProduct(scale_);
    Mat<double, 6, 6> turned;
    const Numbers multipliers(force_.data(), at(group().rows()));
    group().curvature(Rods::platform(), coordinates_, multipliers, turned, force_by_input_);
    Mat<double, 6, 6> stiffness = Rods::stiffness();
    stiffness -= turned;
    inner_ = scaled(stiffness);
    held_ = std::max(inner_.diagonal().template lpNorm<Eigen::Infinity>(), 1e-300);
    const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_rows> scaled_inverse =
        inverse_ * scale_.asDiagonal();
    by_input_ = -scaled_inverse.lazyProduct(by_inputs());
    Mat<double, 6, 6> projected = free_ * inner_ * free_;
    projected += held_ * (Mat<double, 6, 6>::Identity() - free_);
    const Mat<double, 6, 6> whole = unscaled(projected);
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(stiffness_.data()) = whole;
    return lu_.factor(stiffness_.data(), Rods::radius());
  }

  /// With the gaps of the closing legs closed by motions square to the free ones.
  Wrench wrench_residual() const override {
    if (!closes()) return Rods::wrench_residual();
    const Wrench closes = -(inverse_ * gap_);
    const Wrench missing = scaled(Rods::wrench_residual());
    return unscaled(Wrench(free_ * (missing - inner_ * closes) + held_ * closes));
  }
  Twist step(bool fresh) override {
    if (!closes()) return Rods::step(fresh);
    if (!fresh) Rods::step(false);
    const Wrench wanted = wrench_residual();
    Twist twist;
    lu_.solve(wanted.data(), twist.data());
    return twist;
  }
  void move(const Twist& twist, Numbers fed = {}) override {
    Rods::move(twist, fed);
    if (closes() && !fed.empty())
      for (std::size_t k = 0; k < values_.size(); ++k) values_[k] += fed[k];
  }
  const SmallLu<6>& factors() const override { return closes() ? lu_ : Rods::factors(); }
  using Rods::stiffness;
  MatrixView stiffness() const override {
    return closes() ? MatrixView(stiffness_.data(), 6, 6) : Rods::stiffness();
  }
  Wrench input_wrench_jacobian(int input) const override {
    if (!closes()) return Rods::input_wrench_jacobian(input);
    return platform_feed(input) + unscaled(Wrench(held_ * by_input_.col(input)));
  }
  /// @}

  /// @name On the motions that the closing legs leave free
  /// @{
  Mat<double, 6, 6> platform_stiffness() const override {
    if (!closes()) return Rods::stiffness();
    return unscaled(Mat<double, 6, 6>(free_ * inner_ * free_));
  }
  Wrench platform_feed(int input) const override {
    if (!closes()) return Rods::input_wrench_jacobian(input);
    const Wrench own = scaled(Wrench(Rods::input_wrench_jacobian(input) - force_by_input_.col(input)));
    const Wrench moved = by_input_.col(input);  // against this the closing legs move the platform
    return unscaled(Wrench(free_ * (own - inner_ * moved)));
  }
  Wrench project_wrench(const Wrench& wrench) const override {
    if (!closes()) return wrench;
    return unscaled(Wrench(free_ * scaled(wrench)));
  }
  Twist free_motion(const Twist& whole) const override {
    if (!closes()) return whole;
    Twist twist = whole;
    twist.template tail<3>() *= Rods::radius();
    twist = free_ * twist;
    twist.template tail<3>() /= Rods::radius();
    return twist;
  }
  /// @}

  int closing_legs() const override { return closing_legs_; }
  Vec3<double> closing_force(int leg) const override {
    Vec3<double> force = Vec3<double>::Zero();
    robot_.for_each_closing_leg([&]<class L>(const L&, const LegPlace& place, int) {
      if (leg-- != 0) return;
      for (int k = 0; k < L::rows; ++k) {
        const int row = place.template row_of<L>(k);
        force -= force_[row] * directions().row(row).transpose();
      }
    });
    return force;
  }
  void get_closing(std::span<double> coordinates) const override {
    group().to_coordinates(values_, coordinates);
  }
  void set_rods(Numbers coordinates) override {
    Rods::set_rods(coordinates);
    group().to_inputs(coordinates, values_);
  }

 private:
  bool is_rod(int feed) const { return feed < Rods::limbs(); }
  double value_of(int feed) const { return values_[at(Rods::input_of(feed))]; }
  KinematicGroup<AnySpatialLeg> group() const { return KinematicGroup<AnySpatialLeg>(robot_); }

  /// @name Rows as the group wrote them
  /// @{
  template <int Columns>
  using RowsView = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Columns, Eigen::RowMajor>, 0,
                              Eigen::OuterStride<>>;
  RowsView<3> directions() const { return {J_.data(), group().rows(), 3, Eigen::OuterStride<>(6)}; }
  RowsView<Eigen::Dynamic> by_inputs() const {
    return {K_.data(), group().rows(), robot_.total.input, Eigen::OuterStride<>(robot_.total.input)};
  }
  /// Each divided by the length of its direction: gaps in metres, lines of one size.
  void scale_rows() {
    const int count = group().rows();
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> J(J_.data(), count, 6);
    scale_.resize(count);
    for (int k = 0; k < count; ++k) {
      const double length = J.row(k).template head<3>().norm();
      scale_[k] = length > 0 ? 1 / length : 0;
    }
    gap_ = -scale_.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(s_.data(), count));
    lines_ = scale_.asDiagonal() * J;
    lines_.template rightCols<3>() /= Rods::radius();
  }
  /// @}

  /// Moments over the platform's radius, turns times it: numbers of one kind.
  Wrench scaled(Wrench wrench) const {
    wrench.template tail<3>() /= Rods::radius();
    return wrench;
  }
  Wrench unscaled(Wrench wrench) const {
    wrench.template tail<3>() *= Rods::radius();
    return wrench;
  }
  Mat<double, 6, 6> scaled(Mat<double, 6, 6> matrix) const {
    matrix.template bottomRows<3>() /= Rods::radius();
    matrix.template rightCols<3>() /= Rods::radius();
    return matrix;
  }
  Mat<double, 6, 6> unscaled(Mat<double, 6, 6> matrix) const {
    matrix.template bottomRows<3>() *= Rods::radius();
    matrix.template rightCols<3>() *= Rods::radius();
    return matrix;
  }
  /// The pseudoinverse J⁺ of the rows and the projection onto what they leave free, by J = L Q, Q orthonormal
  /// rows, as many as the rank: where rows forbid the same, J⁺ shares their gaps and forces evenly.
  void project() {
    constexpr double independent = 1e-9;  // the rows are unit directions
    RowMatrix left = lines_, along(lines_.rows(), 6);
    Mat<double, 6, 6> basis = Mat<double, 6, 6>::Zero();
    for (rank_ = 0; rank_ < 6; ++rank_) {
      Eigen::Index farthest = 0;
      const double length = left.rowwise().norm().maxCoeff(&farthest);
      if (!(length > independent)) break;
      Eigen::Matrix<double, 1, 6> axis = left.row(farthest) / length;
      axis -= axis * basis.topRows(rank_).transpose() * basis.topRows(rank_);  // once more, for rounding
      axis.normalize();
      basis.row(rank_) = axis;
      along.col(rank_) = left * axis.transpose();
      left -= along.col(rank_) * axis;
    }
    const auto L = along.leftCols(rank_);
    Mat<double, 6, 6> normal = Mat<double, 6, 6>::Identity();
    normal.topLeftCorner(rank_, rank_) = L.transpose() * L;
    const Mat<double, 6, 6> inverse = normal.llt().solve(Mat<double, 6, 6>::Identity());
    inverse_ = basis.topRows(rank_).transpose() * inverse.topLeftCorner(rank_, rank_) * L.transpose();
    free_ = Mat<double, 6, 6>::Identity() - basis.topRows(rank_).transpose() * basis.topRows(rank_);
  }

  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::DontAlign, max_rows, 6>;
  using RowVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, max_rows, 1>;
  SpatialRobot robot_;
  std::vector<int> leg_of_;  ///< of each rod
  int closing_legs_ = 0;
  std::vector<double> values_, coordinates_;  ///< inputs of the robot; those of its rods are not used
  std::array<double, 6 * max_rows> J_{};
  std::array<double, max_rows> s_{};
  std::vector<double> K_;
  RowVector scale_, gap_;  ///< 1 over the length of a row's direction; [m]
  RowMatrix lines_;        ///< unit directions; turns of the platform times its radius
  RowVector force_;        ///< multiplier of each row as the group wrote it
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_rows> inverse_;
  Mat<double, 6, 6> free_ = Mat<double, 6, 6>::Identity();
  Mat<double, 6, 6> inner_ = Mat<double, 6, 6>::Zero();  ///< stiffness of rods and turned lines, scaled
  double held_ = 1;  ///< what stands for the infinite stiffness of held motions: any number of that size
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_rows> by_input_, force_by_input_;
  std::array<double, 36> stiffness_{};
  int rank_;  ///< of the closing legs' rows
  SmallLu<6> lu_;
};

}  // namespace sinew::inline v1
