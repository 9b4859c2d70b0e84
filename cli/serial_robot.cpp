#include "serial_robot.hpp"

#include <fmt/format.h>

#include "io/document/visible.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "request.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::cli {

Expected<SerialRobot> open_serial(const Arguments& arguments) {
  auto document = read_robot_file(arguments.operand());
  if (!document) return tl::unexpected(document.error());
  const auto changes = settings(arguments);
  if (!changes) return tl::unexpected(changes.error());
  if (!is_serial(*document) && !is_arm(*document))
    return failure("not_available", "",
                   fmt::format("{} is no serial robot; {} is for those in this version", arguments.operand(),
                               arguments.verb));
  document = with(*document, *changes);
  auto robot = document ? read_robot(*document) : tl::unexpected(document.error());
  if (robot && robot->arm()) robot = robot->as(Model::cc);
  return robot.map([](const Robot& one) { return *one.serial(); });
}

Expected<kernel::Model> tendon_model(const Arguments& arguments) {
  const std::string* model = arguments.text("model");
  if (!model || *model == "lsk") return kernel::Model::linear;
  if (*model == "pcc") return kernel::Model::exact;
  return failure("unknown_choice", "--model",
                 fmt::format("{} is no model of tendons: write pcc or lsk", in_quotes(*model)));
}

}  // namespace sinew::cli
