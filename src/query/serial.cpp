/// Handlers of queries to serial robots: forward, velocity, describe.
#include "query/serial.hpp"

#include <fmt/format.h>

#include <cmath>

#include "sinew/analysis/serial_shape.hpp"
#include "sinew/io/quantity.hpp"

namespace sinew::inline v0 {

kernel::Model read_tendon_model(SerialContext& context, kernel::Model otherwise) {
  const auto model = context.query.optional("model");
  return model ? model->choice_of<kernel::Model>(
                     {{"pcc", kernel::Model::exact}, {"lsk", kernel::Model::linear}})
               : otherwise;
}

/// At most as many entries as there are sections; the sections after them are straight.
std::vector<Reader> section_items(const SerialContext& context, const Reader& list) {
  auto items = list.items();
  if (items.size() > context.robot.sections.size())
    list.fail("wrong_length", fmt::format("the robot has {} sections, found {} entries",
                                          context.robot.sections.size(), items.size()));
  return items;
}

namespace {

/// Bend of a section from what the protocol calls its configuration, and back.
Bend bend_of(const Section& section, const std::array<double, 2>& given) {
  return section.is_twin() ? Bend(given[0], given[1])
                           : Bend(given[0] * std::cos(given[1]), given[0] * std::sin(given[1]));
}
std::array<double, 2> configuration_of(const Section& section, const Bend& bend) {
  if (section.is_twin()) return {bend.x(), bend.y()};
  // Of a straight section rounding would decide the direction.
  return {bend.norm(), bend.norm() > 1e-14 ? std::atan2(bend.y(), bend.x()) : 0.0};
}

/// The same per section, as the protocol has it.
template <class Values>
Json by_section(const SerialRobot& robot, const Values& values) {
  Json list = Json::array();
  std::size_t first = 0;
  for (const Section& section : robot.sections) {
    const auto count = static_cast<std::size_t>(section.tendons);
    list.push_back(to_json(std::span<const double>(values.data() + first, count)));
    first += count;
  }
  return list;
}

}  // namespace

std::vector<Bend> read_configuration(SerialContext& context, const Reader& list) {
  std::vector<Bend> bends(context.robot.sections.size(), Bend::Zero());
  const auto items = section_items(context, list);
  for (std::size_t m = 0; m < std::min(items.size(), bends.size()); ++m)
    bends[m] = bend_of(context.robot.sections[m], items[m].array<2>(Dimension::angle));
  return bends;
}

Json configuration_json(const SerialRobot& robot, std::span<const Bend> bends) {
  Json list = Json::array();
  for (std::size_t m = 0; m < bends.size(); ++m)
    list.push_back(configuration_of(robot.sections[m], bends[m]));
  return list;
}

Json changes_json(SerialContext& context, std::span<const Bend> bends, kernel::Model model) {
  tendon_changes(bends, model, context.work);
  return by_section(context.robot, context.work.changes);
}

void put_configuration(SerialContext& context, std::span<const Bend> bends, kernel::Model model,
                       std::span<const double> more) {
  Json& answer = context.answer;
  answer["configuration"] = configuration_json(context.robot, bends);
  tendon_changes(bends, model, context.work);
  if (!more.empty()) pay_out(more, context.work);
  answer["changes"] = by_section(context.robot, context.work.changes);
  section_ends(context.robot, bends, context.work);
  if (context.robot.motor) {
    std::vector<double> counts = context.work.changes;
    for (double& count : counts) count *= context.robot.motor->counts_per_length();
    answer["motors"] = by_section(context.robot, counts);
  }
  Json sections = Json::array();
  for (const SE3<double>& end : context.work.ends) sections.push_back(to_json(AnyPose(spatial_pose(end))));
  answer["tip"] = sections.back();
  answer["sections"] = std::move(sections);
}

namespace {

/// Changes of the tendons of the first sections, and how many they are.
std::vector<double> read_changes(SerialContext& context, const Reader& list) {
  std::vector<double> changes;
  const auto items = section_items(context, list);
  for (std::size_t m = 0; m < std::min(items.size(), context.robot.sections.size()); ++m) {
    const auto one = items[m].quantities(Dimension::length, Range::place(),
                                         static_cast<std::size_t>(context.robot.sections[m].tendons));
    changes.insert(changes.end(), one.begin(), one.end());
  }
  return changes;
}

/// What a query gives of the robot's shape, and what became of it.
struct Shaped {
  std::vector<Bend> bends;
  std::optional<std::vector<double>> changes;
  Report report;
};

/// Reads `configuration` or `changes`; solving comes later, when all fields are read.
Shaped read_shape(SerialContext& context) {
  Shaped given;
  const auto configuration = context.query.optional("configuration"),
             changes = context.query.optional("changes");
  if (configuration && changes)
    changes->fail("ambiguous", "the query gives a configuration and changes; keep one");
  else if (changes)
    given.changes = read_changes(context, *changes);
  else if (configuration)
    given.bends = read_configuration(context, *configuration);
  else
    context.query.required("configuration", "per section [theta, phi] or [beta_1, beta_2]; or changes");
  return given;
}

/// `slack`: what every tendon of a section is paid out beyond what its bend needs; of sections not named
/// nothing.
std::vector<double> read_pay_out(SerialContext& context, const Shaped& shape) {
  const auto given = context.query.optional("slack");
  if (!given) return {};
  if (shape.changes) given->fail("no_effect", "has no effect: the changes are given; remove it");
  std::vector<double> more = given->quantities(Dimension::length, Range::place());
  if (more.size() > context.robot.sections.size())
    given->fail("wrong_length", fmt::format("the robot has {} sections, found {} values",
                                            context.robot.sections.size(), more.size()));
  more.resize(context.robot.sections.size(), 0.0);
  return more;
}

/// Bends of the first sections from their tendons; what was not given is straight.
void solve_shape(SerialContext& context, kernel::Model model, Shaped& shape) {
  if (!shape.changes) {
    shape.report = check_limits(context.robot, shape.bends);
    return;
  }
  SerialRobot first = context.robot;
  std::size_t sections = 0, tendons = 0;
  while (tendons < shape.changes->size())
    tendons += static_cast<std::size_t>(first.sections[sections++].tendons);
  first.sections.resize(sections);
  SerialWorkspace work(first);
  shape.report = bends_of_changes(first, *shape.changes, model, work);
  shape.bends = work.bends;
  shape.bends.resize(context.robot.sections.size(), Bend::Zero());
}

/// Columns of J or K from rates of bends to rates of [θ, φ], where that is what the protocol has.
Eigen::MatrixXd by_configuration(const SerialRobot& robot, std::span<const Bend> bends,
                                 const MatrixView& matrix) {
  Eigen::MatrixXd result = matrix;
  for (std::size_t m = 0; m < bends.size(); ++m) {
    if (robot.sections[m].is_twin()) continue;
    const auto [theta, phi] = configuration_of(robot.sections[m], bends[m]);
    Mat<double, 2, 2> turn;
    turn << std::cos(phi), -theta * std::sin(phi), std::sin(phi), theta * std::cos(phi);
    const auto column = static_cast<Eigen::Index>(2 * m);
    result.middleCols<2>(column) = (matrix.middleCols<2>(column) * turn).eval();
  }
  return result;
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// σmax/σmin, and the largest speeds of the tip for bend rates of unit norm.
Json indices_json(const MatrixView& J, double length) {
  const auto ratio = [](const Rows& matrix) {
    std::array<double, max_rows> sigma;
    singular_values(MatrixView(matrix.data(), matrix.rows(), matrix.cols()), sigma);
    const auto last = static_cast<std::size_t>(std::min(matrix.rows(), matrix.cols()) - 1);
    return std::pair(sigma[0], sigma[0] / sigma[last]);
  };
  Rows scaled = J;
  scaled.topRows<3>() /= length;
  Json indices = Json::object();
  const auto put = [&](const char* key, double value) {
    if (value < 1e15) indices[key] = value;  // beyond, it says how the matrix was rounded
  };
  put("condition", ratio(J).second);
  put("condition_homogenised", ratio(scaled).second);
  put("position", ratio(J.topRows<3>()).first);
  put("rotation", ratio(J.bottomRows<3>()).first);
  return indices;
}

/// Rates of the configuration that give the twist, the shortest where there are many.
void put_rates(SerialContext& context, const Eigen::MatrixXd& J, std::span<const double> twist) {
  const Rows matrix = J;
  std::vector<double> rates(static_cast<std::size_t>(J.cols()));
  least_norm(MatrixView(matrix.data(), matrix.rows(), matrix.cols()), twist, rates);
  const Eigen::Map<const Eigen::VectorXd> wanted(twist.data(), 6), found(rates.data(), J.cols());
  if ((J * found - wanted).norm() > 1e-9 * wanted.norm()) {
    Report report;
    report.status = Status::singular;
    report.message.append("no rates of the sections give this twist here");
    return context.report(report);
  }
  Json list = Json::array();
  for (std::size_t m = 0; 2 * m < rates.size(); ++m) list.push_back({rates[2 * m], rates[2 * m + 1]});
  context.answer["rates"] = list;
}

}  // namespace

void answer_serial_forward(SerialContext& context) {
  const kernel::Model model = read_tendon_model(context, kernel::Model::exact);
  Shaped shape = read_shape(context);
  const std::vector<double> more = read_pay_out(context, shape);
  if (!context.ready()) return;
  solve_shape(context, model, shape);
  context.report(shape.report);
  put_configuration(context, shape.bends, model, more);
}

void answer_serial_velocity(SerialContext& context) {
  const kernel::Model model = read_tendon_model(context, kernel::Model::exact);
  Shaped shape = read_shape(context);
  std::vector<double> twist;
  if (const auto asked = context.query.optional("twist")) twist = asked->quantities(Dimension::number, {}, 6);
  if (!context.ready()) return;
  solve_shape(context, model, shape);
  context.report(shape.report);
  tip_motion(context.robot, shape.bends, context.work);
  tendon_rates(shape.bends, model, context.work);
  const Eigen::MatrixXd J = by_configuration(context.robot, shape.bends, context.work.jacobian()),
                        K = by_configuration(context.robot, shape.bends, context.work.tendon_jacobian());
  const Rows j = J, k = K;
  context.answer["configuration"] = configuration_json(context.robot, shape.bends);
  context.answer["tip"] = to_json(AnyPose(spatial_pose(context.work.ends.back())));
  context.answer["J"] = to_json(MatrixView(j.data(), j.rows(), j.cols()));
  context.answer["K"] = to_json(MatrixView(k.data(), k.rows(), k.cols()));
  context.answer["indices"] = indices_json(context.work.jacobian(), context.robot.length());
  if (!twist.empty()) put_rates(context, J, twist);
}

void answer_serial_shape(SerialContext& context) {
  const kernel::Model model = read_tendon_model(context, kernel::Model::exact);
  Shaped given = read_shape(context);
  const auto samples = context.query.optional("samples");
  const int count = samples ? samples->integer(Range::between(2, 200)) : 5;
  if (!context.ready()) return;
  solve_shape(context, model, given);
  context.report(given.report);
  const SerialShape shape = serial_shape(context.robot, given.bends, count);
  const auto polyline = [](const std::vector<Vec3<double>>& line) {
    Json points = Json::array();
    for (const auto& point : line) points.push_back(to_json(point));
    return points;
  };
  Json backbones = Json::array(), tendons = Json::array(), discs = Json::array(), frames = Json::array();
  for (const auto& line : shape.backbones) backbones.push_back(polyline(line));
  for (const auto& section : shape.tendons) {
    Json lines = Json::array();
    for (const auto& line : section) lines.push_back(polyline(line));
    tendons.push_back(std::move(lines));
  }
  for (const DiscShape& disc : shape.discs)
    discs.push_back({{"pose", to_json(AnyPose(spatial_pose(disc.base)))},
                     {"height", disc.height},
                     {"radius", disc.radius}});
  for (const SE3<double>& end : shape.ends) frames.push_back(to_json(AnyPose(spatial_pose(end))));
  context.answer["configuration"] = configuration_json(context.robot, given.bends);
  context.answer["tip"] = frames.back();
  context.answer["backbones"] = std::move(backbones);
  context.answer["tendons"] = std::move(tendons);
  context.answer["discs"] = std::move(discs);
  context.answer["frames"] = std::move(frames);
}

void answer_serial_describe(SerialContext& context) {
  if (!context.ready()) return;
  Json sections = Json::array(), coordinates = Json::array(), inputs = Json::array();
  for (std::size_t m = 0; m < context.robot.sections.size(); ++m) {
    const Section& section = context.robot.sections[m];
    const std::string place = joined("sections", m);
    Json one{
        {"type", section.is_twin() ? "tpcj" : "neutral"},
        {"segments", section.segments},
        {"joint", section.joint},
        {"tendons",
         {{"count", section.tendons}, {"radius", section.tendon_radius}, {"angle", section.tendon_angle}}},
        {"length", section.length()}};
    if (section.disc_radius > 0)
      one["disc"] = {{"height", section.disc_height}, {"radius", section.disc_radius}};
    if (std::isfinite(section.limit)) one["limit"] = section.limit;
    sections.push_back(std::move(one));
    for (const char* name : section.is_twin() ? std::array{"beta_1", "beta_2"} : std::array{"theta", "phi"})
      coordinates.push_back({{"name", joined(place, name)}, {"unit", "rad"}});
    for (int i = 0; i < section.tendons; ++i)
      inputs.push_back(
          {{"name", joined(joined(place, "tendons"), static_cast<std::size_t>(i))}, {"unit", "m"}});
  }
  Json& answer = context.answer;
  answer["status"] = "converged";
  answer["kind"] = "serial";
  answer["space"] = "spatial";
  answer["inputs"] = inputs;
  answer["configuration"] = coordinates;
  answer["sections"] = sections;
  answer["length"] = context.robot.length();
  answer["tolerance"] = context.robot.tolerance;
  if (const auto& motor = context.robot.motor)
    answer["motor"] = {{"lead", motor->lead}, {"counts", motor->counts}, {"gear", motor->gear}};
  if (const auto& stretch = context.robot.stretch)
    answer["stretch"] = {{"stiffness", stretch->stiffness}, {"outside", stretch->outside}};
  answer["models"] = {"pcc", "lsk"};
  answer["model"] = "pcc";
  answer["geometry"] = context.robot.geometry_inferred ? "inferred" : "given";
  answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
}

}  // namespace sinew::inline v0
