/// @file scene.hpp
/// A task of insertion: which serial robot goes in where, what it may not touch, and where its tip is to get.
/// Format: docs/scenes.md
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sinew/io/node.hpp"
#include "sinew/plan/mesh.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// Where the tip is to get, in scene axes.
struct InsertionTarget {
  Vec3<double> tip{0, 0, 0};              ///< [m]
  std::optional<Vec3<double>> direction;  ///< unit vector along the backbone there
  double tolerance = 0.5e-3;              ///< of the tip [m], > 0
  double direction_tolerance = 0.05;      ///< [rad], > 0
};

/// A hole that the robot goes in through: for messages and checks, the meshes are what counts.
struct InsertionPort {
  Vec3<double> position{0, 0, 0};  ///< a point of its axis [m]
  double radius = 0;               ///< [m], > 0
};

/// What bends the robot by its own weight, and what resists.
struct InsertionWeight {
  double by_length = 0;  ///< of robot and what it carries [N/m], ≥ 0
  double stiffness = 0;  ///< EI of the round backbone in its joints [N m²], > 0
};

/// The whole task, in scene axes.
struct InsertionScene {
  std::string name;
  std::string robot_name;  ///< as the scene writes it
  SerialRobot robot;
  SE3<double> base;            ///< of the robot where its stage is at 0, in scene axes [m]
  Vec3<double> axis{0, 0, 1};  ///< unit vector in which the stage moves the base
  double stage_limit = 0;      ///< most that the stage moves it [m], > 0
  std::optional<InsertionPort> port;
  InsertionTarget target;
  double clearance = 0.5e-3;  ///< that a plan keeps between robot and solids [m], > 0
  double model_error = 0;     ///< what the robot may be off its kinematics [m], ≥ 0
  double tension = 0;         ///< greatest of any tendon [N], ≥ 0; > 0: the robot says how tendons stretch
  std::optional<InsertionWeight> weight;
  std::vector<Mesh> solids;
};

/// The scene that a document describes, or every error of it and of its meshes at once.
/// @param folder that file names of robot and meshes are relative to
SINEW_API Expected<InsertionScene> read_scene(const Document& document, const std::filesystem::path& folder);

/// The scene in a file.
SINEW_API Expected<InsertionScene> load_scene(const std::filesystem::path& path);

}  // namespace sinew::inline v1
