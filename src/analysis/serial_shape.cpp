#include "link/bent_joint.hpp"
#include "sinew/analysis/shape.hpp"

namespace sinew::inline v1 {
namespace {

/// Pose at a share of a joint's arc: a shorter arc, bent by as much less.
SE3<double> along(double joint, const Bend& bend, double share) {
  return BentJoint{share * joint, 0}.pose(share * bend.x(), share * bend.y()).rigid();
}

/// Frames of the robot's discs and points of its backbone.
struct Walk {
  SerialShape shape;
  std::vector<std::array<SE3<double>, 2>> faces;  ///< proximal and distal face of every disc
  std::vector<std::size_t> last;                  ///< of every section: number of discs up to its end

  Walk(const SerialRobot& robot, std::span<const Bend> bends, int samples) {
    SE3<double> end = SE3<double>::identity();
    for (std::size_t m = 0; m < bends.size(); ++m) {
      const Section& section = robot.sections[m];
      auto& line = shape.backbones.emplace_back(1, end.p);
      for (int k = 0; k < section.segments; ++k) {
        const Bend bend = section.joint_bend(bends[m], k);
        for (int i = 1; i < samples; ++i)
          line.push_back(end.compose(along(section.joint, bend, static_cast<double>(i) / (samples - 1))).p);
        const SE3<double> face = end.compose(along(section.joint, bend, 1));
        end = face.compose({Vec3<double>(0, 0, section.disc_height), {}});
        faces.push_back({face, end});
        if (section.disc_height > 0) line.push_back(end.p);
        if (section.disc_radius > 0) shape.discs.push_back({face, section.disc_height, section.disc_radius});
      }
      shape.ends.push_back(end);
      last.push_back(faces.size());
    }
  }
};

/// One tendon: a hole in the base, then two holes a disc. The radius is that of the section passed.
std::vector<Vec3<double>> tendon(const SerialRobot& robot, const Walk& walk, std::size_t section,
                                 int number) {
  const auto direction = robot.sections[section].direction(number);
  const auto hole = [&](const SE3<double>& face, double radius) {
    return face.point(Vec3<double>(radius * direction.cosine, radius * direction.sine, 0));
  };
  std::vector<Vec3<double>> line{hole(SE3<double>::identity(), robot.sections[0].tendon_radius)};
  for (std::size_t m = 0, k = 0; m <= section; ++m)
    for (; k < walk.last[m]; ++k)
      for (const SE3<double>& face : walk.faces[k])
        line.push_back(hole(face, robot.sections[m].tendon_radius));
  return line;
}

}  // namespace

SerialShape serial_shape(const SerialRobot& robot, std::span<const Bend> bends, int samples) {
  if (bends.size() != robot.sections.size() || samples < 2) return {};
  Walk walk(robot, bends, samples);
  for (std::size_t m = 0; m < bends.size(); ++m) {
    auto& lines = walk.shape.tendons.emplace_back();
    for (int i = 0; i < robot.sections[m].tendons; ++i) lines.push_back(tendon(robot, walk, m, i));
  }
  return std::move(walk.shape);
}

}  // namespace sinew::inline v1
