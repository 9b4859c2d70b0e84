/// A joint bent in space, its derivatives, and poses that move with one bend.
#include "link/bent_joint.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "check_jacobian.hpp"
#include "link/bent_motion.hpp"

namespace sinew::test {
namespace bent_joint_test {

constexpr BentJoint joint{.length = 0.2375, .disc = 0.2}, arc{.length = 1, .disc = 0};
constexpr JacobianCheck whole{.unit = 1};  // all numbers compared are of size 1

/// Position, then the rotation's matrix, columns first.
template <class S>
Vec<S, 12> numbers(const BentPose<S>& pose) {
  const SE3<S> rigid = pose.rigid();
  const Mat<S, 3, 3> R = rigid.R.matrix();
  Vec<S, 12> all;
  all << rigid.p, R.col(0), R.col(1), R.col(2);
  return all;
}

/// The derivatives of these numbers.
Eigen::MatrixXd number_rates(const BentMotion<double>& motion) {
  const SE3<double> rigid = motion.pose.rigid();
  const Mat<double, 3, 3> R = rigid.R.matrix();
  double shift[3][2], turn[3][2];
  for (int i = 0; i < 3; ++i) {
    motion.shift[i].store(shift[i]);
    motion.turn[i].store(turn[i]);
  }
  Eigen::MatrixXd rates(12, 2);
  for (int j = 0; j < 2; ++j) {
    const Vec3<double> w(turn[0][j], turn[1][j], turn[2][j]);
    rates.col(j) << shift[0][j], shift[1][j], shift[2][j], cross(w, R.col(0)), cross(w, R.col(1)),
        cross(w, R.col(2));
  }
  return rates;
}

/// Random directions at every size that formulas may treat otherwise.
std::vector<Vec2<double>> bends() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  std::vector<Vec2<double>> all = {{0, 0}, {1e-9, 0}, {0, -1e-9}, {0.5, 0}, {0, 0.5}};
  for (const double size :
       {1e-300, 1e-9, 1e-4, 0.1, 0.42, 0.499999, 0.500001, 1.0, 1.9999, 2.0001, 3.0, 3.1415926, 5.0, 9.0})
    for (int i = 0; i < 5; ++i) {
      const double direction = angle(random);
      all.emplace_back(size * std::cos(direction), size * std::sin(direction));
    }
  return all;
}

TEST(BentJoint, IsAnArcOfItsLengthAndThenADisc) {  // @verifies LSK (3), (4)
  for (const Vec2<double>& bend : bends()) {
    const long double x = bend.x(), y = bend.y(), a = std::sqrt(x * x + y * y);
    if (a < 1e-150L) continue;
    const long double side = joint.length * (1 - std::cos(a)) / a + joint.disc * std::sin(a),
                      ahead = joint.length * std::sin(a) / a + joint.disc * std::cos(a);
    const SE3<double> end = joint.pose(bend.x(), bend.y()).rigid();
    const double near = 4e-16;
    if (a > 1e-5L) {  // where 1 − cos still has digits
      EXPECT_NEAR(end.p.x(), static_cast<double>(side * x / a), near);
      EXPECT_NEAR(end.p.y(), static_cast<double>(side * y / a), near);
    }
    EXPECT_NEAR(end.p.z(), static_cast<double>(ahead), near);
    const Vec3<double> axis = end.rotate(Vec3<double>(0, 0, 1));
    EXPECT_NEAR(axis.x(), static_cast<double>(std::sin(a) * x / a), 1e-15);
    EXPECT_NEAR(axis.y(), static_cast<double>(std::sin(a) * y / a), 1e-15);
    EXPECT_NEAR(axis.z(), static_cast<double>(std::cos(a)), 1e-15);
  }
}

TEST(BentJoint, StraightIsAnOrdinaryPoint) {
  const SE3<double> end = joint.pose(0.0, 0.0).rigid();
  EXPECT_EQ(end.p, Vec3<double>(0, 0, joint.length + joint.disc));
  EXPECT_EQ(end.R.w, 1);
  // the side it bends to is linear in the smallest of bends
  EXPECT_DOUBLE_EQ(joint.pose(1e-200, 0.0).p[0] / 1e-200, joint.length / 2 + joint.disc);
}

constexpr BentJoint joints{.length = 0.03, .disc = 0.02, .count = 9};

TEST(BentJoint, ManyAreOneAfterTheOther) {
  for (const Vec2<double>& bend : bends()) {
    BentPose<double> end;
    const BentPose<double> one =
        BentJoint{.length = joints.length, .disc = joints.disc}.pose(bend.x() / 9, bend.y() / 9);
    for (int i = 0; i < 9; ++i) end = end.then(one);
    EXPECT_LT((numbers(joints.pose(bend.x(), bend.y())) - numbers(end)).lpNorm<Eigen::Infinity>(), 6e-15)
        << bend.norm();
  }
}

TEST(BentJoint, DerivativesMatchComplexStepAndDifferences) {
  for (const BentJoint& link : {joint, arc, joints})
    for (const Vec2<double>& bend : bends()) {
      const auto ends = [&]<class S>(const Vec<S, 2>& b) { return numbers(link.pose(S(b[0]), S(b[1]))); };
      EXPECT_LT(check_jacobian(ends, bend, number_rates(link.motion(bend.x(), bend.y())), whole), 1e-12)
          << bend.transpose();
      EXPECT_LT(
          jacobian_error(number_rates(link.motion(bend.x(), bend.y())), complex_step_jacobian(ends, bend), 1),
          4e-15)
          << bend.transpose();
    }
}

TEST(BentJoint, ABendAboutOneAxisIsTheSame) {
  for (const double bend : {0.0, 1e-9, -0.3, 0.42, 0.499, 0.501, -1.7, 3.0}) {
    const auto pivot = joint.pivot(bend);
    const auto motion = joint.motion(bend, 0.0);
    double rate[2];
    EXPECT_NEAR(pivot.side, motion.pose.p[0], 1e-16);
    EXPECT_NEAR(pivot.ahead, motion.pose.p[2], 1e-16);
    motion.shift[0].store(rate);
    EXPECT_NEAR(pivot.side_rate, rate[0], 1e-16);
    motion.shift[2].store(rate);
    EXPECT_NEAR(pivot.ahead_rate, rate[0], 1e-16);
    EXPECT_NEAR(pivot.sine, std::sin(bend), 1e-15);
    EXPECT_NEAR(pivot.cosine, std::cos(bend), 1e-15);
    EXPECT_NEAR(pivot.half_sine, std::sin(bend / 2), 1e-15);
    EXPECT_NEAR(pivot.half_cosine, std::cos(bend / 2), 1e-15);
  }
}

TEST(BentMotion, OneAfterAnotherMovesAsBoth) {
  for (const Vec2<double>& bend : bends()) {
    const auto both = [&]<class S>(const Vec<S, 2>& b) {
      return numbers(joint.pose(S(b[0]), S(b[1])).then(arc.pose(S(b[0]), S(b[1]))));
    };
    const auto motion = joint.motion(bend.x(), bend.y()).then(arc.motion(bend.x(), bend.y()));
    EXPECT_LT(check_jacobian(both, bend, number_rates(motion), whole), 1e-12) << bend.transpose();
  }
}

}  // namespace bent_joint_test
}  // namespace sinew::test
