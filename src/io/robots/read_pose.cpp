#include "io/robots/read_pose.hpp"

#include "io/document/reader.hpp"
#include "math/tilt.hpp"

namespace sinew::inline v1 {

PlanarPose read_planar_pose(Reader pose) {
  PlanarPose result;
  result.x = pose.required("x").quantity(Dimension::length, PoseRange::coordinate);
  result.y = pose.required("y").quantity(Dimension::length, PoseRange::coordinate);
  result.phi = pose.required("phi").quantity(Dimension::angle, PoseRange::angle);
  pose.close();
  return result;
}

namespace {

/// By these angles, if any of them is given.
std::optional<SO3<double>> read_tilt(Reader& pose) {
  TiltTorsion angles;
  bool is_given = false;
  for (const auto& [key, angle] :
       {std::pair{"tilt", &angles.tilt}, {"azimuth", &angles.azimuth}, {"torsion", &angles.torsion}})
    if (const auto given = pose.optional(key)) {
      *angle = given->quantity(Dimension::angle, PoseRange::angle);
      is_given = true;
    }
  return is_given ? std::optional(rotation_of(angles)) : std::nullopt;
}

}  // namespace

SpatialPose read_spatial_pose(Reader pose) {
  SpatialPose result;
  const auto position =
      pose.required("position", "[x, y, z]").array<3>(Dimension::length, PoseRange::coordinate);
  result.position = Vec3<double>(position[0], position[1], position[2]);
  if (const auto quaternion = pose.optional("quaternion")) {
    result.quaternion = quaternion->array<4>(Dimension::number, PoseRange::coordinate);
    double square = 0;
    for (const double q : result.quaternion) square += q * q;
    if (square < PoseRange::least_square) {
      quaternion->fail("no_rotation", "a quaternion [w, x, y, z] needs a component that is not 0");
      result.quaternion = {1, 0, 0, 0};
    }
  }
  if (const auto turn = read_tilt(pose)) {
    if (pose.has("quaternion"))
      pose.fail("ambiguous",
                "quaternion and tilt, azimuth, torsion both say how the platform is turned; keep one");
    result.quaternion = {turn->w, turn->v.x(), turn->v.y(), turn->v.z()};
  }
  pose.close();
  return spatial_pose(SE3<double>::from(result));
}

Vec3<double> read_gravity(const Reader& gravity) {
  const auto [x, y, z] = gravity.array<3>(Dimension::acceleration, Range::between(-1e6, 1e6));
  return {x, y, z};
}

std::array<double, 3> read_gravity_of(const Reader& gravity, bool is_planar) {
  const Vec3<double> g = read_gravity(gravity);
  if (is_planar && g.z() != 0)
    gravity.fail("no_effect",
                 "its third number has no effect: it acts out of the plane in which alone the robot moves; "
                 "write 0");
  return {g.x(), g.y(), g.z()};
}

}  // namespace sinew::inline v1
