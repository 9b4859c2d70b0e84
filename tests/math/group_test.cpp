/// One property suite over the groups: every fact for SE2, SO3 and SE3, always at the identity, its 1e-8
/// neighbour, the thresholds of the entire functions, and angles near π.
#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

#include "check_jacobian.hpp"
#include "sinew/math/se2.hpp"
#include "sinew/math/se3.hpp"

namespace sinew {
namespace group_test {

constexpr double pi = std::numbers::pi;

/// What the suite needs to know of a group: its size, where the turn sits in a twist, and its matrices.
struct Planar {
  template <class S>
  using Group = SE2<S>;
  static constexpr int size = 3, turn_at = 2;
  static Eigen::MatrixXd matrix(const SE2<double>& x) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(3, 3);
    m.topLeftCorner(2, 2) << x.c, -x.s, x.s, x.c;
    m.topRightCorner(2, 1) = x.p;
    return m;
  }
};
struct Rotation {
  template <class S>
  using Group = SO3<S>;
  static constexpr int size = 3, turn_at = 0;
  static Eigen::MatrixXd matrix(const SO3<double>& x) { return x.matrix(); }
};
struct Spatial {
  template <class S>
  using Group = SE3<S>;
  static constexpr int size = 6, turn_at = 3;
  static Eigen::MatrixXd matrix(const SE3<double>& x) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Identity(4, 4);
    m.topLeftCorner(3, 3) = x.R.matrix();
    m.topRightCorner(3, 1) = x.p;
    return m;
  }
};

template <class T>
class Group : public testing::Test {
 protected:
  using Element = typename T::template Group<double>;
  using Twist = Vec<double, T::size>;

  static std::vector<Twist> twists() {
    std::mt19937 engine(42);
    std::normal_distribution<double> normal;
    std::vector<Twist> all{Twist::Zero(), Twist::Constant(1e-8), Twist::Constant(-1e-8),
                           Twist::Constant(1e-160)};
    for (double angle : {1e-12, 1e-8, 1e-4, 0.5, 0.999999, 1.000001, 1.999999, 2.000001, 2.9999, 3.0001,
                         pi - 1e-4, pi - 1e-8, pi - 1e-12, -(pi - 1e-8)})
      for (int repeat = 0; repeat < 3; ++repeat) {
        Twist twist;
        for (int i = 0; i < T::size; ++i) twist[i] = normal(engine);
        auto turn = twist.template tail<T::size - T::turn_at>();
        turn *= angle / turn.norm();
        all.push_back(twist);
      }
    return all;
  }

  /// Largest difference of the matrices, relative to their size (positions are of order 1).
  static double distance(const Element& a, const Element& b) {
    return (T::matrix(a) - T::matrix(b)).cwiseAbs().maxCoeff();
  }
};

using Groups = testing::Types<Planar, Rotation, Spatial>;
TYPED_TEST_SUITE(Group, Groups);

TYPED_TEST(Group, LogUndoesExp) {
  using G = typename TestFixture::Element;
  for (const auto& twist : this->twists()) {
    const auto back = G::exp(twist).log();
    EXPECT_LT((back - twist).norm(), 2e-15 * std::max(1e-140, twist.norm()) + 2e-15 * (twist.norm() > 0.1));
    EXPECT_LT(this->distance(G::exp(back), G::exp(twist)), 2e-15);
  }
}

TYPED_TEST(Group, ExpIsTheMatrixExponential) {
  using G = typename TestFixture::Element;
  for (const auto& twist :
       this->twists()) {  // the group's own squaring, against its linear part: X = exp(ξ/2ᵏ)^(2ᵏ)
    typename TestFixture::Twist part = twist / 1024;
    G x = G::exp(part);
    for (int i = 0; i < 10; ++i) x = x.compose(x);
    EXPECT_LT(this->distance(x, G::exp(twist)), 1e-12);
  }
}

TYPED_TEST(Group, ComposeAndInverseAreThoseOfTheMatrices) {
  using G = typename TestFixture::Element;
  for (const auto& twist : this->twists()) {
    const G x = G::exp(twist), y = G::exp(this->twists().back());
    const Eigen::MatrixXd product = TypeParam::matrix(x) * TypeParam::matrix(y);
    EXPECT_LT((TypeParam::matrix(x.compose(y)) - product).cwiseAbs().maxCoeff(), 4e-15);
    EXPECT_LT(this->distance(x.compose(x.inverse()), G::identity()), 5e-15);
    EXPECT_LT(this->distance(x.inverse().compose(x), G::identity()), 5e-15);
    EXPECT_LT(this->distance(x.compose(G::identity()), x), 1e-16);
  }
}

TYPED_TEST(Group, AdjointMovesATwistToBaseAxes) {
  using G = typename TestFixture::Element;
  for (const auto& twist : this->twists()) {
    const G x = G::exp(twist), y = G::exp(this->twists()[20]);
    const typename TestFixture::Twist moved = x.adjoint() * this->twists()[20];
    EXPECT_LT(this->distance(x.compose(y).compose(x.inverse()), G::exp(moved)), 2e-14);
    EXPECT_LT((x.compose(y).adjoint() - x.adjoint() * y.adjoint()).cwiseAbs().maxCoeff(), 2e-14);
  }
}

TYPED_TEST(Group, LeftJacobianIsTheDerivativeOfExp) {
  using G = typename TestFixture::Element;
  for (const auto& twist : this->twists()) {
    const auto moved = [&]<class S>(const Vec<S, TypeParam::size>& at) {
      using H = typename TypeParam::template Group<S>;
      const Vec<S, TypeParam::size> start = twist.template cast<S>();
      return Vec<S, TypeParam::size>(H::exp(at).compose(H::exp(start).inverse()).log());
    };
    EXPECT_LT(test::check_jacobian(moved, twist, G::left_jacobian(twist)), 2e-11) << twist.transpose();
    const Eigen::MatrixXd exact = test::complex_step_jacobian(moved, twist);
    EXPECT_LT(test::jacobian_error(G::left_jacobian(twist), exact), 1e-14) << twist.transpose();
  }
}

TYPED_TEST(Group, FloatWorks) {
  using F = typename TypeParam::template Group<float>;
  const auto twist = this->twists()[12].template cast<float>().eval();
  EXPECT_LT((F::exp(twist).log() - twist).norm(), 1e-6F);
}

TEST(SO3, LeftJacobianInverseIsTheInverse) {
  for (double angle : {0.0, 1e-8, 0.3, 1.0, 2.0, 3.0, pi, 4.0, 6.0}) {
    const Vec3<double> turn = angle * Vec3<double>(2, -1, 2) / 3;
    const Mat<double, 3, 3> unit =
        SO3<double>::left_jacobian(turn) * SO3<double>::left_jacobian_inverse(turn);
    EXPECT_LT((unit - Mat<double, 3, 3>::Identity()).norm(), 2e-14) << angle;
  }
}

TEST(SO3, LogAtHalfATurnIsOneOfTheTwo) {
  for (const Vec3<double>& axis :
       {Vec3<double>(1, 0, 0), Vec3<double>(0, -0.6, 0.8), Vec3<double>(0.48, 0.6, -0.64)}) {
    const Vec3<double> turn = SO3<double>{0.0, axis}.log();
    EXPECT_NEAR(turn.norm(), pi, 1e-15);
    EXPECT_LT((turn - pi * axis).norm(), 1e-15);
  }
  const Vec3<double> past = SO3<double>::exp(Vec3<double>(0, 0, pi + 0.1)).log();  // the short way round
  EXPECT_LT((past - Vec3<double>(0, 0, 0.1 - pi)).norm(), 2e-15);
}

TEST(SO3, MatrixAndQuaternionAgreeWhicheverComponentLeads) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    SO3<double> q{normal(engine), {normal(engine), normal(engine), normal(engine)}};
    if (i % 4 == 0) q.w *= 1e-9;  // turns near π
    if (i % 5 == 0) q.v[i % 3] *= 1e-12;
    q = q.normalised().canonical();
    const auto back = SO3<double>::from(q.matrix());
    EXPECT_LT((back.v - q.v).norm() + std::abs(back.w - q.w), 2e-15);
    EXPECT_LT((q.rotate(q.v) - q.v).norm(), 1e-15);
    EXPECT_LT((q.matrix().transpose() * q.matrix() - Mat<double, 3, 3>::Identity()).norm(), 5e-15);
  }
}

TEST(SO3, CanonicalSignIsUnique) {
  const auto canonical = [](double w, double x, double y, double z) {
    const auto q = SO3<double>{w, {x, y, z}}.canonical();
    return std::array{q.w, q.v[0], q.v[1], q.v[2]};
  };
  EXPECT_EQ(canonical(-0.6, 0.8, 0, 0), (std::array{0.6, -0.8, -0.0, -0.0}));
  EXPECT_EQ(canonical(0, 0, -0.6, 0.8), (std::array{-0.0, -0.0, 0.6, -0.8}));
  EXPECT_EQ(canonical(0, 0, 0.6, -0.8), (std::array{0.0, 0.0, 0.6, -0.8}));
}

TEST(SE2, WrapAngleIsExactAndHasNoMinusPi) {
  EXPECT_EQ(wrap_angle(-pi), pi);
  EXPECT_EQ(wrap_angle(pi), pi);
  EXPECT_EQ(wrap_angle(2 * pi), 0.0);
  EXPECT_EQ(wrap_angle(0.1), 0.1);
  EXPECT_EQ(wrap_angle(std::nextafter(pi, 4.0)), -std::nextafter(pi, 0.0));
  EXPECT_EQ(wrap_angle(-std::nextafter(pi, 4.0)), std::nextafter(pi, 0.0));
  EXPECT_EQ(planar_pose(SE2<double>::from(1, 2, -pi)).phi, -pi + 2 * pi);
  EXPECT_NEAR(planar_pose(SE2<double>::from(1, 2, 7)).phi, 7 - 2 * pi, 1e-15);
}

TEST(SE2, RotateBackUndoesRotate) {
  const auto x = SE2<double>::from({.x = 1, .y = -2, .phi = 0.7});
  const Vec2<double> b(0.3, 0.4);
  EXPECT_LT((x.rotate_back(x.rotate(b)) - b).norm(), 1e-16);
  EXPECT_LT((x.inverse().point(x.point(b)) - b).norm(), 1e-15);
}

TEST(Displaced, IsAMotionInBaseAxesAboutTheReferencePoint) {
  const auto x = SE2<double>::from(1.0, 2.0, 3.0).displaced({0.1, 0.2, 0.3});
  EXPECT_LT((x.p - Vec2<double>(1.1, 2.2)).norm(), 1e-15);
  EXPECT_NEAR(wrap_angle(x.angle() - 3.3), 0, 1e-15);
  Vec<double, 6> motion;
  motion << 1, 2, 3, 0.2, -0.1, 0.4;
  const SE3<double> at = SE3<double>::from({{1, 1, 1}, {0.5, 0.5, -0.5, 0.5}}), y = at.displaced(motion);
  EXPECT_LT((y.p - Vec3<double>(2, 3, 4)).norm(), 1e-15);
  const Vec3<double> turn = y.R.compose(at.R.inverse()).log();
  EXPECT_LT((turn - Vec3<double>(0.2, -0.1, 0.4)).norm(), 1e-15);
}

TEST(Displaced, DoesNotDriftFromTheGroup) {
  auto planar = SE2<double>::identity();
  auto spatial = SE3<double>::identity();
  Vec<double, 6> motion = Vec<double, 6>::Constant(0.1);
  for (int i = 0; i < 100000; ++i) {
    planar = planar.displaced({0, 0, 0.1});
    spatial = spatial.displaced(motion);
  }
  EXPECT_NEAR(planar.c * planar.c + planar.s * planar.s, 1, 1e-15);
  EXPECT_NEAR(spatial.R.w * spatial.R.w + spatial.R.v.squaredNorm(), 1, 1e-15);
}

TEST(SE3, PoseRoundTripIsCanonical) {
  const SpatialPose pose = spatial_pose(SE3<double>::from({{1, 2, 3}, {-1, 1, 1, -1}}));
  EXPECT_EQ(pose.position, Vec3<double>(1, 2, 3));
  EXPECT_EQ(pose.quaternion, (std::array<double, 4>{0.5, -0.5, -0.5, 0.5}));
}

}  // namespace group_test
}  // namespace sinew
