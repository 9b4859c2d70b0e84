// A way in, and its check, from an installed sinew::plan.
#include <sinew/plan/insertion.hpp>
#include <sinew/robot.hpp>

int main() {
  sinew::InsertionScene scene;
  scene.robot = sinew::load_serial("nottingham-tpcj").value();
  scene.base.p = sinew::Vec3<double>(0, 0, -scene.robot.length());
  scene.stage_limit = 0.15;
  scene.target.tip = sinew::Vec3<double>(0.02, 0, 0.1);
  sinew::Mesh box = sinew::box_mesh({0.01, 0.1, 0.01});
  box.name = "box";
  scene.solids = {sinew::moved(box, {{0.02, 0, 0.05}, {}})};
  const sinew::InsertionPlan plan = sinew::plan_insertion(scene);
  return plan.report.ok() && plan.check.verdict != sinew::InsertionVerdict::touches ? 0 : 1;
}
