/// @file mechanism.hpp
/// A platform on a group of rods and on legs that close, if there are any: the equations of the rods,
/// projected onto the motions that the closing legs leave free, so that Newton's method sees six equations
/// as ever. Theory: docs/theory/mixed_robot.md
#pragma once
#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "base/at.hpp"
#include "robot/closing_legs.hpp"
#include "robot/rod_group.hpp"

namespace sinew::inline v0 {

/// The face of `Rods`, to which it adds the closing legs; without any it is that of the rods. No function
/// here allocates unless it says so.
/// @tparam Rods a group of rods: RodSystem, TangentSystem or GeneralSystem
template <class Rods>
class Mechanism : public Rods {
 public:
  using Wrench = Vec<double, 6>;
  using Twist = Vec<double, 6>;

  /// Allocates.  @param rods with their places in the whole robot
  explicit Mechanism(const ParallelRobot<RodLeg>& rods, std::vector<ClosingLeg> closing = {})
      : Rods(rods),
        closing_(std::move(closing), rods.total.input),
        fed_(static_cast<std::size_t>(closing_.feeds()), 0.0),
        rank_(std::min(closing_.rows(), 6)) {}

  /// Whether legs close beside the rods.
  bool closes() const { return closing_.rows() > 0; }

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
  int undriven() const { return std::max(rank_ - closing_.feeds(), 0); }
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
    const double own = Rods::evaluate(anew);
    if (!closes()) return own;
    closing_.rows_at(Rods::platform(), fed_, rows_);
    for (int k = 0; k < rows_.count; ++k) rows_.by_platform.row(k).template tail<3>() /= Rods::radius();
    if (!rows_.by_platform.topRows(rows_.count).allFinite()) return std::numeric_limits<double>::quiet_NaN();
    project();
    const Wrench left = free_ * scaled(Rods::missing());
    double force = 0, length = 0;
    for (int k = 0; k < Rods::rods(); ++k) {
      force = std::max(force, Rods::stiffness(k) / (Rods::length(k) * Rods::length(k)));
      length = std::max(length, Rods::length(k));
    }
    const double gap = rows_.gap.head(rows_.count).template lpNorm<Eigen::Infinity>() / length;
    const double error = std::max({Rods::rod_error(), gap, left.template lpNorm<Eigen::Infinity>() / force});
    return std::isnan(gap + left.sum()) ? std::numeric_limits<double>::quiet_NaN() : error;
  }
  /// Of rods and closing legs: that of the platform is not among them.
  double rod_error() const { return Rods::rod_error(); }

  bool linearise() {
    const bool is_held = Rods::linearise();
    if (!closes()) return is_held;  // else the rods alone need not hold the platform
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
    if (!closes()) return Rods::missing();
    const Wrench closes = -(inverse_ * rows_.gap.head(rows_.count));
    const Wrench missing = scaled(Rods::missing());
    return unscaled(Wrench(free_ * (missing - inner_ * closes) + held_ * closes));
  }
  Twist step(bool fresh) {
    if (!closes()) return Rods::step(fresh);
    if (!fresh) Rods::step(false);
    const Wrench wanted = missing();
    Twist twist;
    lu_.solve(wanted.data(), twist.data());
    return twist;
  }
  void move(const Twist& twist, std::span<const double> fed = {}) {
    Rods::move(twist, fed);
    if (closes() && !fed.empty())
      for (int k = 0; k < closing_.feeds(); ++k) fed_[at(k)] += fed[at(closing_.input_of(k))];
  }
  Lu6 factors() const { return closes() ? lu_ : Rods::factors(); }
  MatrixView stiffness() const { return closes() ? MatrixView(stiffness_.data(), 6, 6) : Rods::stiffness(); }
  double stiffness(int rod) const { return Rods::stiffness(rod); }
  Wrench feed_wrench(int input) const {
    if (!closes()) return Rods::feed_wrench(input);
    return platform_feed(input) + unscaled(Wrench(held_ * by_input_.col(input)));
  }
  /// @}

  /// @name On the motions that the closing legs leave free
  /// @{
  Mat<double, 6, 6> platform_stiffness() const {
    if (!closes()) return Rods::stiffness();
    return unscaled(Mat<double, 6, 6>(free_ * inner_ * free_));
  }
  Wrench platform_feed(int input) const {
    if (!closes()) return Rods::feed_wrench(input);
    const Wrench own = scaled(Wrench(Rods::feed_wrench(input) - force_by_input_.col(input)));
    const Wrench moved = by_input_.col(input);  // against this the closing legs move the platform
    return unscaled(Wrench(free_ * (own - inner_ * moved)));
  }
  /// What of a load they leave to the rods.
  Wrench felt(const Wrench& wrench) const {
    if (!closes()) return wrench;
    return unscaled(Wrench(free_ * scaled(wrench)));
  }
  /// What of a twist they allow.
  Twist free_motion(Twist twist) const {
    if (!closes()) return twist;
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
  /// The pseudoinverse J⁺ of the rows and the projection onto what they leave free, by J = L Q, Q orthonormal
  /// rows, as many as the rank: where rows forbid the same, J⁺ shares their gaps and forces evenly.
  void project() {
    constexpr double independent = 1e-9;  // the rows are unit directions
    const int count = rows_.count;
    RowMatrix left = rows_.by_platform.topRows(count), along(count, 6);
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

  using RowMatrix =
      Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::DontAlign | Eigen::ColMajor, max_closing_rows, 6>;
  ClosingLegs closing_;
  std::vector<double> fed_;  ///< inputs of the closing legs
  ClosingRows rows_;         ///< turns of the platform times its radius
  Vec<double, max_closing_rows> force_ = Vec<double, max_closing_rows>::Zero();  ///< of each row [N]
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_closing_rows> inverse_;
  Mat<double, 6, 6> free_ = Mat<double, 6, 6>::Identity();
  Mat<double, 6, 6> inner_ = Mat<double, 6, 6>::Zero();  ///< stiffness of rods and turned lines, scaled
  double held_ = 1;  ///< what stands for the infinite stiffness of held motions: any number of that size
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::DontAlign, 6, max_rows> by_input_, force_by_input_;
  std::array<double, 36> stiffness_{};
  int rank_;  ///< of the closing legs' rows
  Lu6 lu_;
};

}  // namespace sinew::inline v0
