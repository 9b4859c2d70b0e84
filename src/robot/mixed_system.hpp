/// @file mixed_system.hpp
/// Rods and closing legs between a base and a platform: the equations of the rods, projected onto the motions
/// that the closing legs leave free, so that Newton's method sees six equations as ever.
/// Theory: docs/theory/mixed_robot.md
#pragma once
#include <algorithm>
#include <limits>

#include "base/at.hpp"
#include "robot/closing_legs.hpp"
#include "robot/tangent_system.hpp"

namespace sinew::inline v0 {

/// A robot of both kinds of legs, taken apart.
struct MixedRobot {
  ParallelRobot<RodLeg> rods;  ///< with their places in the whole robot
  std::vector<ClosingLeg> closing;
};

/// The face of `Rods`, to which it adds the closing legs. No function here allocates unless it says so.
/// @tparam Rods a system of rods
template <class Rods>
class MixedSystem : public Rods {
 public:
  using Wrench = Vec<double, 6>;
  using Twist = Vec<double, 6>;

  explicit MixedSystem(const MixedRobot& robot)  ///< allocates
      : Rods(robot.rods),
        closing_(robot.closing, robot.rods.total.input),
        fed_(static_cast<std::size_t>(closing_.feeds()), 0.0) {}

  struct Snapshot : Rods::Snapshot {
    std::vector<double> closing;
  };
  Snapshot snapshot() const {
    Snapshot to{Rods::snapshot(), fed_};
    return to;
  }
  void save(Snapshot& to) const {
    Rods::save(to);
    std::ranges::copy(fed_, to.closing.begin());
  }
  void restore(const Snapshot& from) {
    Rods::restore(from);
    std::ranges::copy(from.closing, fed_.begin());
  }

  int leg_of(int rod) const {
    int leg = rod;
    for (const ClosingLeg& other : closing_.legs()) leg += other.index <= leg;  // in ascending order
    return leg;
  }
  /// Motions that the closing legs forbid, less those their own inputs drive.
  int undriven() const { return closing_.rows() - closing_.feeds(); }
  /// @name What inputs feed: the rods, then what the closing legs are driven by
  /// @{
  int feeds() const { return Rods::rods() + closing_.feeds(); }
  int input_of(int feed) const { return is_rod(feed) ? Rods::input_of(feed) : closing_.input_of(own(feed)); }
  double length(int feed) const { return is_rod(feed) ? Rods::length(feed) : fed_[at(own(feed))]; }
  void set_length(int feed, double value) {
    if (is_rod(feed))
      Rods::set_length(feed, value);
    else
      fed_[at(own(feed))] = value;
  }
  bool in_domain(int feed, double value) const {
    return is_rod(feed) ? Rods::in_domain(feed, value) : closing_.in_domain(own(feed), value);
  }
  void set_inputs(std::span<const double> inputs) {
    Rods::set_inputs(inputs);
    for (int k = 0; k < closing_.feeds(); ++k) fed_[at(k)] = inputs[at(closing_.input_of(k))];
  }
  /// Inputs of the closing legs that close them where the platform is; false where one cannot.
  bool close() { return closing_.close_at(Rods::platform(), fed_); }
  /// @}

  /// @name Newton's method
  /// @{
  double evaluate(bool anew = true) {
    Rods::evaluate(anew);
    closing_.rows_at(Rods::platform(), fed_, rows_);
    for (int k = 0; k < rows_.count; ++k) rows_.by_platform.row(k).template tail<3>() /= Rods::radius();
    gap_ = rows_.gap;
    if (!project()) return std::numeric_limits<double>::quiet_NaN();
    const Wrench left = free_ * scaled(Rods::missing());
    double force = 0, length = 0;
    for (int k = 0; k < Rods::rods(); ++k) {
      force = std::max(force, Rods::stiffness(k) / (Rods::length(k) * Rods::length(k)));
      length = std::max(length, Rods::length(k));
    }
    const double gap = gap_.head(rows_.count).template lpNorm<Eigen::Infinity>() / length;
    const double error = std::max({Rods::rod_error(), gap, left.template lpNorm<Eigen::Infinity>() / force});
    return std::isnan(gap + left.sum()) ? std::numeric_limits<double>::quiet_NaN() : error;
  }
  /// Of rods and closing legs: that of the platform is not among them.
  double rod_error() const { return Rods::rod_error(); }

  bool linearise() {
    Rods::linearise();  // which alone may not hold the platform
    // the closing legs push with what is missing, along their rows
    const Wrench missing = scaled(Rods::missing());
    force_.setZero();
    force_.head(rows_.count) = -(inverse_.transpose() * missing).head(rows_.count);
    Mat<double, 6, 6> turned;
    closing_.force_change(Rods::platform(), fed_, rows_, force_, turned, force_by_input_);
    Mat<double, 6, 6> stiffness = Rods::stiffness();
    stiffness -= turned;
    inner_ = scaled(stiffness);
    held_ = std::max(inner_.diagonal().template lpNorm<Eigen::Infinity>(), 1e-300);
    by_input_ = inverse_ * rows_.by_input;
    Mat<double, 6, 6> projected = free_ * inner_ * free_;
    projected += held_ * (Mat<double, 6, 6>::Identity() - free_);
    const Mat<double, 6, 6> whole = unscaled(projected);
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(stiffness_.data()) = whole;
    return lu_.factor(stiffness_.data(), Rods::radius());
  }

  /// With the gaps of the closing legs closed by motions square to the free ones.
  Wrench missing() const {
    const Wrench closes = -(inverse_ * gap_.head(rows_.count));
    const Wrench missing = scaled(Rods::missing());
    return unscaled(Wrench(free_ * (missing - inner_ * closes) + held_ * closes));
  }
  Twist step(bool fresh) {
    if (!fresh) Rods::step(false);
    const Wrench wanted = missing();
    Twist twist;
    lu_.solve(wanted.data(), twist.data());
    return twist;
  }
  void move(const Twist& twist, std::span<const double> fed = {}) {
    Rods::move(twist, fed);
    if (!fed.empty())
      for (int k = 0; k < closing_.feeds(); ++k) fed_[at(k)] += fed[at(closing_.input_of(k))];
  }
  Lu6 factors() const { return lu_; }
  MatrixView stiffness() const { return {stiffness_.data(), 6, 6}; }
  double stiffness(int rod) const { return Rods::stiffness(rod); }
  Wrench feed_wrench(int input) const {
    return platform_feed(input) + unscaled(Wrench(held_ * by_input_.col(input)));
  }
  /// @}

  /// @name On the motions that the closing legs leave free
  /// @{
  Mat<double, 6, 6> platform_stiffness() const { return unscaled(Mat<double, 6, 6>(free_ * inner_ * free_)); }
  Wrench platform_feed(int input) const {
    const Wrench own = scaled(Wrench(Rods::feed_wrench(input) - force_by_input_.col(input)));
    const Wrench moved = by_input_.col(input);  // against this the closing legs move the platform
    return unscaled(Wrench(free_ * (own - inner_ * moved)));
  }
  Wrench felt(const Wrench& wrench) const { return unscaled(Wrench(free_ * scaled(wrench))); }
  /// What of a twist they allow.
  Twist free_motion(Twist twist) const {
    twist.template tail<3>() *= Rods::radius();
    twist = free_ * twist;
    twist.template tail<3>() /= Rods::radius();
    return twist;
  }
  /// @}

  std::span<const ClosingLeg> closing_legs() const { return closing_.legs(); }
  /// Of the platform on a closing leg, at its platform point, base axes [N]; after `linearise`.
  Vec3<double> closing_force(int leg) const {
    int first = 0;
    for (int k = 0; k < leg; ++k) first += rows_of(k);
    Vec3<double> force = Vec3<double>::Zero();
    for (int k = first; k < first + rows_of(leg); ++k)
      force -= force_[k] * rows_.by_platform.row(k).template head<3>().transpose();
    return force;
  }
  void get_closing(std::span<double> coordinates) const { closing_.get_coordinates(fed_, coordinates); }
  void set_rods(std::span<const double> coordinates) {
    Rods::set_rods(coordinates);
    closing_.set_coordinates(coordinates, fed_);
  }

 private:
  bool is_rod(int feed) const { return feed < Rods::rods(); }
  int own(int feed) const { return feed - Rods::rods(); }
  int rows_of(int leg) const {
    return with_leg(closing_.legs()[at(leg)].leg, []<class L>(const L&) { return L::rows; });
  }

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
  /// The pseudoinverse of the rows and the projection onto what they leave free. False where two of them
  /// forbid the same.
  bool project() {
    const auto rows = rows_.by_platform.topRows(rows_.count);
    Mat<double, max_closing_rows, max_closing_rows> square;
    square.setIdentity();
    square.topLeftCorner(rows_.count, rows_.count) = rows * rows.transpose();
    Mat<double, max_closing_rows, max_closing_rows> inverse;
    if (!solve(row_major(square), row_major(Mat<double, 6, 6>(Mat<double, 6, 6>::Identity())),
               std::span(buffer_)))
      return false;
    inverse = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(buffer_.data());
    inverse_.setZero(6, rows_.count);
    inverse_ = rows.transpose() * inverse.topLeftCorner(rows_.count, rows_.count);
    free_ = Mat<double, 6, 6>::Identity() - inverse_ * rows;
    return true;
  }
  /// Symmetric matrices alone: rows first is columns first.
  static MatrixView row_major(const Mat<double, 6, 6>& symmetric) { return {symmetric.data(), 6, 6}; }

  ClosingLegs closing_;
  std::vector<double> fed_;  ///< inputs of the closing legs
  ClosingRows rows_;         ///< turns of the platform times its radius
  Vec<double, max_closing_rows> gap_ = Vec<double, max_closing_rows>::Zero();
  Vec<double, max_closing_rows> force_ = Vec<double, max_closing_rows>::Zero();  ///< of each row [N]
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_closing_rows> inverse_;
  Mat<double, 6, 6> free_ = Mat<double, 6, 6>::Identity();
  Mat<double, 6, 6> inner_ = Mat<double, 6, 6>::Zero();  ///< stiffness of rods and turned lines, scaled
  double held_ = 1;  ///< what stands for the infinite stiffness of held motions: any number of that size
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_rows> by_input_, force_by_input_;
  std::array<double, 36> stiffness_{}, buffer_{};
  Lu6 lu_;
};

}  // namespace sinew::inline v0
