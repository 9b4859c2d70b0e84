/// `forward`, `velocity` and `shape` of serial robots.
#include "query/serial/serial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "math/linalg.hpp"
#include "query/batch/sampler.hpp"
#include "query/questions.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {

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

bool is_straight(const Bend& bend) { return bend.norm() <= 1e-14; }

/// The inverse of `bend_of`.
/// @param straight φ of a straight section, where rounding would decide it
std::array<double, 2> configuration_of(const Section& section, const Bend& bend, double straight) {
  if (section.is_twin()) return {bend.x(), bend.y()};
  return {bend.norm(), is_straight(bend) ? straight : std::atan2(bend.y(), bend.x())};
}

/// The same per section, as the protocol has it.
template <class Values>
Value by_section(const SerialRobot& robot, const Values& values) {
  Value list = Value::list();
  std::size_t first = 0;
  for (const Section& section : robot.sections) {
    const auto count = static_cast<std::size_t>(section.tendons);
    list.push_back(Value(std::span<const double>(values.data() + first, count)));
    first += count;
  }
  return list;
}

}  // namespace

SerialConfiguration read_configuration(SerialContext& context, const Reader& list) {
  const std::size_t count = context.robot.sections.size();
  SerialConfiguration shape{{}, std::vector<Bend>(count, Bend::Zero()), std::vector<double>(count, 0.0)};
  const auto items = section_items(context, list);
  for (std::size_t m = 0; m < std::min(items.size(), count); ++m) {
    const Section& section = context.robot.sections[m];
    const std::size_t given = items[m].is(Node::Kind::list) ? items[m].node()->items.size() : 0;
    const bool has_extension = section.is_extensible() && given == 3;
    if (section.is_extensible() && given > 3) {
      items[m].fail("wrong_length",
                    fmt::format("there are {} values; give 2, or 3 with the extension", given));
      continue;
    }
    const auto parts = items[m].items(has_extension ? 3 : 2);
    if (parts.size() < 2 || given != parts.size()) continue;
    shape.given.push_back(
        {parts[0].quantity(Dimension::angle, bend_range), parts[1].quantity(Dimension::angle, bend_range)});
    shape.bends[m] = bend_of(section, shape.given.back());
    if (has_extension) shape.extensions[m] = parts[2].quantity(Dimension::length, Range::place());
  }
  return shape;
}

Value configuration_value(const SerialContext& context, std::span<const Bend> bends,
                          std::span<const double> straight) {
  Value list = Value::list();
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const Section& section = context.robot.sections[m];
    Value one = configuration_of(section, bends[m], straight.empty() ? 0 : straight[m]);
    if (section.is_extensible()) one.push_back(context.work.extensions[m]);
    list.push_back(std::move(one));
  }
  return list;
}

Value changes_value(SerialContext& context, std::span<const Bend> bends, kernel::Model model) {
  tendon_changes(bends, model, context.work);
  return by_section(context.robot, context.work.changes);
}

void put_configuration(SerialContext& context, std::span<const Bend> bends, kernel::Model model,
                       std::span<const double> more, std::span<const double> given) {
  Value& answer = context.answer;
  answer["configuration"] = configuration_value(context, bends);
  tendon_changes(bends, model, context.work);
  if (!more.empty()) add_slack(more, context.work);
  std::copy(given.begin(), given.end(), context.work.changes.begin());
  answer["changes"] = by_section(context.robot, context.work.changes);
  section_ends(bends, context.work);
  if (context.robot.motor) {
    std::vector<double> counts = context.work.changes;
    for (double& count : counts) count *= context.robot.motor->counts_per_length();
    answer["motors"] = by_section(context.robot, counts);
  }
  Value sections = Value::list();
  for (const SE3<double>& end : context.work.ends) sections.push_back(pose_value(AnyPose(spatial_pose(end))));
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
    static_cast<SerialConfiguration&>(given) = read_configuration(context, *configuration);
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

/// The shape of the first sections from their tendons; what was not given is straight. The workspace has its
/// lengths then.
void solve_shape(SerialContext& context, kernel::Model model, Shaped& shape) {
  if (!shape.changes) {
    shape.report = check_limits(context.robot, shape.bends, shape.extensions);
  } else {
    SerialRobot first = context.robot;
    std::size_t sections = 0, tendons = 0;
    while (tendons < shape.changes->size())
      tendons += static_cast<std::size_t>(first.sections[sections++].tendons);
    first.sections.resize(sections);
    SerialWorkspace work(first);
    shape.report = bends_of_changes(first, *shape.changes, model, work);
    shape.bends = work.bends;
    shape.bends.resize(context.robot.sections.size(), Bend::Zero());
    shape.extensions = work.extensions;
    shape.extensions.resize(context.robot.sections.size(), 0.0);
    shape.slack = work.slack;
    shape.slack.resize(context.work.slack.size(), 0.0);
  }
  set_extensions(context.robot, shape.extensions, context.work);
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// J and K, a column for each coordinate of the protocol's configuration.
struct ByConfiguration {
  Rows J, K;
};

/// By rates of [θ, φ], where that is what the protocol has, and of extensions.
ByConfiguration by_configuration(const SerialContext& context, std::span<const Bend> bends,
                                 std::span<const double> straight) {
  const auto& sections = context.robot.sections;
  const SerialWorkspace& work = context.work;
  Eigen::Index columns = 0;
  for (const Section& section : sections) columns += section.is_extensible() ? 3 : 2;
  const MatrixView J = work.jacobian(), K = work.tendon_jacobian();
  ByConfiguration by{Rows::Zero(6, columns), Rows::Zero(K.rows(), columns)};
  Eigen::Index column = 0, row = 0;
  for (std::size_t m = 0; m < bends.size(); ++m) {
    Mat<double, 2, 2> turn = Mat<double, 2, 2>::Identity();
    if (!sections[m].is_twin()) {
      const auto [theta, phi] = configuration_of(sections[m], bends[m], straight[m]);
      turn << std::cos(phi), -theta * std::sin(phi), std::sin(phi), theta * std::cos(phi);
    }
    const auto from = static_cast<Eigen::Index>(2 * m);
    by.J.middleCols<2>(column) = J.middleCols<2>(from) * turn;
    by.K.middleCols<2>(column) = K.middleCols<2>(from) * turn;
    column += 2;
    if (sections[m].is_extensible()) {
      by.J.col(column).head<3>() = work.extension_jacobians[m].tip;
      by.K.col(column).tail(K.rows() - row).setConstant(work.extension_jacobians[m].tendons);
      ++column;
    }
    row += sections[m].tendons;
  }
  return by;
}

/// The largest singular value, and it over the smallest.
std::pair<double, double> largest_and_ratio(const Rows& matrix) {
  std::array<double, 6> sigma{};
  const auto values =
      std::span(sigma).first(static_cast<std::size_t>(std::min(matrix.rows(), matrix.cols())));
  singular_values(MatrixView(matrix.data(), matrix.rows(), matrix.cols()), values);
  return {values.front(), values.front() / values.back()};
}

/// σmax/σmin, and the largest speeds of the tip for rates of unit norm: of bends in rad, not of [θ, φ], and
/// of extensions as shares of the robot's length.
Value indices_value(const SerialContext& context) {
  const SerialWorkspace& work = context.work;
  const double length = context.robot.length();
  Rows J = work.jacobian();
  for (std::size_t m = 0; m < context.robot.sections.size(); ++m) {
    if (!context.robot.sections[m].is_extensible()) continue;
    J.conservativeResize(6, J.cols() + 1);
    J.rightCols<1>() << length * work.extension_jacobians[m].tip, 0, 0, 0;
  }
  Rows scaled = J;
  scaled.topRows<3>() /= length;
  Value indices = Value::map();
  const auto put = [&](Value::Key key, double value) {
    if (value < 1e15) indices[key] = value;  // beyond, it says how the matrix was rounded
  };
  put("condition", largest_and_ratio(J).second);
  put("condition_homogenised", largest_and_ratio(scaled).second);
  put("position", largest_and_ratio(J.topRows<3>()).first);
  put("rotation", largest_and_ratio(J.bottomRows<3>()).first);
  return indices;
}

/// Rates of [θ, φ] or [β₁, β₂] and of the extension, from those of bends. A straight section starts towards
/// where its bend goes: that is its φ.
Value rates_value(const SerialContext& context, std::span<const Bend> bends, const ResolvedRate& found,
                  std::span<double> straight) {
  Value list = Value::list();
  for (std::size_t m = 0; m < bends.size(); ++m) {
    const Section& section = context.robot.sections[m];
    Bend rate(found.bends[2 * m], found.bends[2 * m + 1]);
    if (!section.is_twin() && is_straight(bends[m])) {
      if (rate.norm() > 0) straight[m] = std::atan2(rate.y(), rate.x());
      rate = {rate.norm(), 0};
    } else if (!section.is_twin()) {
      const double theta = bends[m].norm();
      const Bend along = bends[m] / theta;
      rate = {along.dot(rate), (along.x() * rate.y() - along.y() * rate.x()) / theta};
    }
    Value one{rate.x(), rate.y()};
    if (section.is_extensible()) one.push_back(found.extensions[m]);
    list.push_back(std::move(one));
  }
  return list;
}

/// A shape that would fill the memory of whoever asks.
void refuse_many_points(SerialContext& context, int samples) {
  constexpr std::size_t most = 1000000;
  std::size_t points = 0, segments = 0;
  for (const Section& section : context.robot.sections) {
    segments += static_cast<std::size_t>(section.segments);
    points += static_cast<std::size_t>(section.segments * samples) +
              2 * segments * static_cast<std::size_t>(section.tendons);
  }
  if (points > most)
    context.query.fail(
        "out_of_range",
        fmt::format("the shape has {} points, this version writes at most {}: ask for fewer samples, "
                    "or have fewer segments",
                    points, most));
}

void put_velocity(SerialContext& context, std::span<const Bend> bends, kernel::Model model,
                  std::span<const double> twist) {
  std::vector<double> straight(bends.size(), 0.0);
  Value rates;
  if (!twist.empty()) {
    const TipTwist wanted{{twist[0], twist[1], twist[2]}, {twist[3], twist[4], twist[5]}};
    const ResolvedRate found = resolved_rate(context.robot, bends, wanted, {.model = model}, context.work);
    if (found.ok())
      rates = rates_value(context, bends, found, straight);
    else
      context.add_report(found.report);
  }
  tip_motion(bends, context.work);
  tendon_rates(bends, model, context.work);
  extension_motion(bends, model, context.work);
  const auto [J, K] = by_configuration(context, bends, straight);
  Value& answer = context.answer;
  answer["configuration"] = configuration_value(context, bends, straight);
  if (!answer.contains("tip")) answer["tip"] = pose_value(AnyPose(spatial_pose(context.work.ends.back())));
  answer["J"] = Value(MatrixView(J.data(), J.rows(), J.cols()));
  answer["K"] = Value(MatrixView(K.data(), K.rows(), K.cols()));
  answer["indices"] = indices_value(context);
  if (const auto steering = tip_steering(context.work))
    answer["steering"] =
        Value(std::array{(*steering)(0, 0), (*steering)(0, 1), (*steering)(1, 0), (*steering)(1, 1)}, 2);
  if (!rates.is_null()) answer["rates"] = std::move(rates);
}

Value polyline(const std::vector<Vec3<double>>& line) {
  std::vector<double> numbers;
  numbers.reserve(3 * line.size());
  for (const auto& point : line) numbers.insert(numbers.end(), point.begin(), point.end());
  return {numbers, 3};
}

void put_shape_of(SerialContext& context, std::span<const Bend> bends, int samples) {
  const SerialShape shape = serial_shape(context.robot.extended(context.work.extensions), bends, samples);
  Value backbones = Value::list(), tendons = Value::list(), discs = Value::list(), frames = Value::list();
  for (const auto& line : shape.backbones) backbones.push_back(polyline(line));
  for (const auto& section : shape.tendons) {
    Value lines = Value::list();
    for (const auto& line : section) lines.push_back(polyline(line));
    tendons.push_back(std::move(lines));
  }
  for (const DiscShape& disc : shape.discs)
    discs.push_back({{"pose", pose_value(AnyPose(spatial_pose(disc.base)))},
                     {"height", disc.height},
                     {"radius", disc.radius}});
  for (const SE3<double>& end : shape.ends) frames.push_back(pose_value(AnyPose(spatial_pose(end))));
  Value& answer = context.answer;
  if (!answer.contains("configuration")) answer["configuration"] = configuration_value(context, bends);
  if (!answer.contains("tip")) answer["tip"] = frames.back();
  answer["backbones"] = std::move(backbones);
  answer["tendons"] = std::move(tendons);
  answer["discs"] = std::move(discs);
  answer["frames"] = std::move(frames);
}

}  // namespace

SerialWants read_serial_wants(SerialContext& context) {
  SerialWants wanted{read_wants(context), {}, 0};
  refuse_without(context, wanted.words, Want::velocity, {"twist"});
  if (wanted.words.has(Want::velocity))
    if (const auto asked = context.query.optional("twist"))
      wanted.twist = asked->quantities(Dimension::number, Range::place(), 6);
  wanted.samples = read_samples(context, wanted.words, 5, 200);
  if (wanted.words.has(Want::shape)) refuse_many_points(context, wanted.samples);
  return wanted;
}

void put_serial_wants(SerialContext& context, std::span<const Bend> bends, kernel::Model model,
                      const SerialWants& wanted) {
  if (wanted.words.has(Want::velocity)) put_velocity(context, bends, model, wanted.twist);
  if (wanted.words.has(Want::shape)) put_shape_of(context, bends, wanted.samples);
}

void SerialQuestion::read() {
  model = read_tendon_model(*this, kernel::Model::exact);
  shape = read_shape(*this);
  if (ask == Ask::forward) pay_out = read_pay_out(*this, shape);
  wanted = read_serial_wants(*this);
}

void SerialQuestion::solve() { solve_shape(*this, model, shape); }

void SerialQuestion::tell() {
  report(shape.report);
  if (ask == Ask::forward) {
    put_configuration(*this, shape.bends, model, pay_out,
                      shape.changes ? std::span<const double>(*shape.changes) : std::span<const double>());
    if (shape.changes) answer["slack"] = by_section(robot, shape.slack);
  }
  put_serial_wants(*this, shape.bends, model, wanted);
}

namespace {

constexpr std::string_view bears_none =
    "a serial robot by pcc or lsk bears no load: it takes the shape that the lengths of its tendons give; "
    "leave it out";
constexpr Lack lacking[] = {{"wrench", bears_none}, {"gravity", bears_none}, {"until", bears_none}};

}  // namespace

constexpr Handlers serial_handlers{.robots = "serial robots",
                                   .wants = {Want::pose, Want::velocity, Want::shape},
                                   .answers = {.forward = answer_question<SerialQuestion>,
                                               .inverse = answer_serial_inverse,
                                               .velocity = answer_question<SerialQuestion>,
                                               .shape = answer_question<SerialQuestion>,
                                               .diagram = answer_serial_diagram,
                                               .describe = answer_serial_describe},
                                   .lacks = lacking,
                                   .plan = plan_sections};

}  // namespace sinew::inline v1
