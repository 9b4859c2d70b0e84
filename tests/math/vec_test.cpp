#include "sinew/math/vec.hpp"

#include <gtest/gtest.h>

#include "math/linalg.hpp"
#include "sinew/math/se3.hpp"

namespace sinew {
namespace vec_test {

static_assert(Scalar<double> && Scalar<float> && Scalar<std::complex<double>>);
static_assert(!Scalar<int> && !Scalar<const char*>);

// The layouts a consumer's -march cannot change.
static_assert(alignof(Vec2<double>) == alignof(double) && sizeof(Vec2<double>) == 2 * sizeof(double));
static_assert(alignof(Mat<double, 4, 4>) == alignof(double));
static_assert(sizeof(SE2<double>) == 4 * sizeof(double));
static_assert(sizeof(SE3<double>) == 7 * sizeof(double) && alignof(SE3<double>) == alignof(double));
static_assert(sizeof(SpatialPose) == 7 * sizeof(double));
static_assert(alignof(Svd) == alignof(double));

TEST(Vec, CrossInThePlaneIsTheTurnFromAToB) {
  const Vec2<double> a(1, 2), b(3, 4);
  EXPECT_EQ(cross(a, b), -2.0);
  EXPECT_EQ(cross(a - b, b), -2.0);  // expressions as well
  EXPECT_EQ(dot(perp(a), b), cross(a, b));
  EXPECT_EQ(perp(a), Vec2<double>(-2, 1));
}

TEST(Vec, CrossInSpaceIsRightHanded) {
  const Vec3<double> x(1, 0, 0), y(0, 1, 0);
  EXPECT_EQ(cross(x, y), Vec3<double>(0, 0, 1));
  EXPECT_EQ(skew<double>(x) * y, cross(x, y));
}

TEST(Vec, ProductsAreAnalyticWhereEigenConjugates) {
  using C = std::complex<double>;
  const Vec2<C> z(C(0, 1), C(0, 0));
  EXPECT_EQ(squared_norm(z), C(-1, 0));
  EXPECT_EQ(dot(z, z), C(-1, 0));
  EXPECT_EQ(z.squaredNorm(), 1.0);
}

}  // namespace vec_test
}  // namespace sinew
