/// The one Jacobian suite that every robot whose legs close passes, built-in or from a file: J and K against
/// differences of the residuals, at random configurations, straight links and type II poses. Those of rods
/// are in rod_stiffness_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "check_jacobian.hpp"
#include "every_robot.hpp"
#include "io/robots/serial_file.hpp"
#include "paths.hpp"

namespace sinew::test {
namespace jacobian_test {

std::vector<std::string> every_robot() {
  std::vector<std::string> names;
  for (const std::string_view name : builtin_robot_names()) names.emplace_back(name);
  for (const std::string_view name : robot_template_names())
    names.push_back(std::string(source_folder) + "/examples/robots/" + std::string(name) + ".yaml");
  std::erase_if(names, [](const std::string& name) {
    return is_serial(read_robot_file(name).value()) || load(name).value().arm_legs() ||
           bears_load(load(name).value());
  });
  return names;
}

class EveryRobotsJacobians : public testing::TestWithParam<std::string> {
 protected:
  Robot robot = load(GetParam()).value();
  Workspace work{robot};
  std::mt19937 random{20261121};

  /// Residuals g at a pose moved by a small motion, with these inputs.
  Eigen::VectorXd residual(const AnyPose& pose, const Eigen::VectorXd& step,
                           const std::vector<double>& inputs) {
    EXPECT_TRUE(coordinates_from_inputs(robot, inputs, work).ok());
    const std::vector<double> coordinates = work.coordinates;
    const Reduced at = assemble(robot, moved(pose, step), coordinates, work);
    return -Eigen::Map<const Eigen::VectorXd>(at.s.data(), static_cast<Eigen::Index>(at.s.size()));
  }

  /// Worst error of J and K against differences at this configuration, which need not close the legs.
  double worst_error(const AnyPose& pose, const std::vector<double>& inputs) {
    EXPECT_TRUE(coordinates_from_inputs(robot, inputs, work).ok());
    const std::vector<double> coordinates = work.coordinates;
    const Reduced at = assemble(robot, pose, coordinates, work);
    const Eigen::MatrixXd J = at.J, K = at.K;
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(J.cols());
    const auto by_pose = [&](const Eigen::VectorXd& step) { return residual(pose, step, inputs); };
    const auto by_inputs = [&](const Eigen::VectorXd& a) {
      return residual(pose, still, std::vector<double>(a.begin(), a.end()));
    };
    const Eigen::VectorXd a = Eigen::Map<const Eigen::VectorXd>(inputs.data(), K.cols());
    return std::max(jacobian_error(J, central_jacobian(by_pose, still, 1e-3)),
                    jacobian_error(-K, central_jacobian(by_inputs, a, 1e-4)));
  }

  /// Inputs of links bent at random, or all straight.
  std::vector<double> bent(double most) {
    std::vector<double> inputs;
    for (const InputOfLeg& input : inputs_of(robot))
      inputs.push_back(input.dimension == Dimension::angle ? uniform(random, -3, 3) : 0);
    with_closing_legs(
        robot,
        [&](const auto& r) {
          r.for_each_closing_leg([&]<class L>(const L& leg, const LegPlace& place, int) {
            auto q = L::Coordinates::Zero().eval();
            for (int j = 0; j + 1 < L::coordinates; ++j) q[j] = uniform(random, -3, 3);
            q[L::coordinates - 1] = uniform(random, -most, most);
            const auto a = leg.inputs_of(q);
            std::copy(a.begin(), a.end(), inputs.begin() + place.input);
          });
        },
        [] {});
    return inputs;
  }
};

TEST_P(EveryRobotsJacobians, AreTheDerivativesAnywhere) {
  double worst = 0;
  for (int sample = 0; sample < 200; ++sample)
    worst = std::max(worst, worst_error(pose_near_home(robot, random, 0.1, 1.5), bent(20)));
  EXPECT_LT(worst, 1e-7);
}

TEST_P(EveryRobotsJacobians, AreTheDerivativesOfStraightLinks) {
  double worst = 0;
  for (int sample = 0; sample < 50; ++sample)
    worst =
        std::max(worst, worst_error(pose_near_home(robot, random, 0.1, 1.5), bent(sample % 2 ? 0 : 1e-6)));
  EXPECT_LT(worst, 1e-7);
}

TEST_P(EveryRobotsJacobians, AreTheDerivativesWhereThePlatformIsTurnedIntoASingularity) {
  double worst = 0;
  for (const double turn :
       {std::numbers::pi / 3, std::numbers::pi / 2, -std::numbers::pi / 2, std::numbers::pi})
    for (int sample = 0; sample < 10; ++sample) {
      const AnyPose pose = moved(home(robot), turn * Eigen::VectorXd::Unit(dof(robot), dof(robot) - 1));
      worst = std::max(worst, worst_error(pose, bent(15)));
    }
  EXPECT_LT(worst, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(All, EveryRobotsJacobians, testing::ValuesIn(every_robot()), [](const auto& robot) {
  std::string name = std::filesystem::path(robot.param).stem().string();
  std::ranges::replace(name, '-', '_');
  return (robot.param.find('/') == std::string::npos ? "builtin_" : "file_") + name;
});

}  // namespace jacobian_test
}  // namespace sinew::test
