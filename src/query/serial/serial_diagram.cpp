/// `diagram`: what the tendons of one section leave it free to do.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document/reader.hpp"
#include "query/questions.hpp"
#include "query/serial/serial.hpp"
#include "tendon/state.hpp"

namespace sinew::inline v1 {
namespace {

/// Changes of the tendons of section m and of all before it; those before are straight where only its own are
/// given.
struct TendonsTo {
  std::vector<double> changes;
  std::size_t first = 0;  ///< of the section's own
};

std::size_t tendons_before(const SerialRobot& robot, std::size_t section) {
  std::size_t count = 0;
  for (std::size_t m = 0; m < section; ++m) count += static_cast<std::size_t>(robot.sections[m].tendons);
  return count;
}

TendonsTo read_tendons(const SerialContext& context, const Reader& list, std::size_t section) {
  TendonsTo read{{}, tendons_before(context.robot, section)};
  const auto count = [&](std::size_t m) {
    return static_cast<std::size_t>(context.robot.sections[m].tendons);
  };
  const bool is_own = list.is(Node::Kind::list) && !list.node()->items.empty() &&
                      list.node()->items[0].kind != Node::Kind::list;
  if (is_own) {
    read.changes.assign(read.first, 0.0);
    const auto own = list.quantities(Dimension::length, Range::place(), count(section));
    read.changes.insert(read.changes.end(), own.begin(), own.end());
    return read;
  }
  const auto items = list.items(section + 1);
  for (std::size_t m = 0; m < std::min(items.size(), section + 1); ++m) {
    const auto one = items[m].quantities(Dimension::length, Range::place(), count(m));
    read.changes.insert(read.changes.end(), one.begin(), one.end());
  }
  read.changes.resize(read.first + count(section), 0.0);
  return read;
}

Envelope read_envelope(SerialContext& context, const Section& section) {
  Envelope envelope{section.is_twin() ? Envelope::Kind::square : Envelope::Kind::disc, section.limit};
  const auto kind = context.query.optional("envelope");
  const auto limit = context.query.optional("limit");
  if (kind)
    envelope.kind = kind->choice_of<Envelope::Kind>({{"square", Envelope::Kind::square},
                                                     {"disc", Envelope::Kind::disc},
                                                     {"actuator", Envelope::Kind::actuator}});
  const bool is_travel = envelope.kind == Envelope::Kind::actuator;
  if (limit)
    envelope.limit = limit->quantity(is_travel ? Dimension::length : Dimension::angle, Range::not_negative());
  else if (is_travel)
    context.query.required("limit", "largest change of a tendon");
  else if (!std::isfinite(envelope.limit))
    context.query.required("limit", "largest bend: the section has none of its own");
  return envelope;
}

constexpr std::string_view names[] = {"exact", "indeterminate", "inconsistent", "unreachable"};

Value points_value(const std::vector<Vec2<double>>& points) {
  Value list = Value::list();
  for (const auto& point : points) list.push_back(Value(point));
  return list;
}

/// A question about one section, with the storage its views point to.
struct Asked {
  SerialRobot first;  ///< the sections before it
  SerialWorkspace work;
  DiagramQuestion question;
  bool is_conditional = false;  ///< the section before it is not exact
  Report earlier;               ///< of the sections before it
  double own_extension = 0;     ///< how much longer than at rest it is itself [m]

  Asked(const SerialContext& context, std::size_t section)
      : first(context.robot),
        work((first.sections.resize(section), first)) {}
};

/// What earlier sections ask of this one's tendons, where their own tendons put them.
void put_earlier(Asked& asked, const TendonsTo& tendons) {
  asked.earlier = bends_of_changes(asked.first, Numbers(std::span(tendons.changes).first(tendons.first)),
                                   asked.question.model, asked.work);
  asked.question.earlier = pull_of_all(asked.work.bends, asked.question.model, asked.work);
  if (asked.first.sections.empty()) return;
  const auto last = static_cast<std::size_t>(asked.first.sections.back().tendons);
  for (const double slack : std::span(asked.work.slack).last(last))
    asked.is_conditional = asked.is_conditional || std::abs(slack) > asked.question.tolerance;
}

/// The length of a section whose length varies is what its own tendons have in common, as far as that goes:
/// beyond the limits they are slack, or too short.
void take_extension(Asked& asked, const TendonsTo& tendons, const SerialRobot& robot, std::size_t m) {
  SerialRobot up_to = robot;
  up_to.sections.resize(m + 1);
  SerialWorkspace work(up_to);
  bends_of_changes(up_to, Numbers(tendons.changes), asked.question.model, work);
  asked.own_extension = work.extensions[m];
  asked.question.section = robot.sections[m].extended(asked.own_extension).map();
  asked.question.earlier.common += asked.own_extension;
}

void put_state(Value& answer, const DiagramQuestion& question, const SectionDiagram& diagram) {
  const StateWords state = state_words(question, diagram);
  answer["class"] = names[static_cast<std::size_t>(diagram.agree)];
  answer["partial"] = diagram.partial;
  answer["word"] = state.word;
  put_number(answer, "amount", state.amount);
  answer["near_limit"] = state.is_near_limit;
  answer["advice"] = state.advice;
  answer["point"] = Value(diagram.point);
  answer["slack"] = Value(diagram.slack);
  put_number(answer, "margin", diagram.margin);
  put_number(answer, "over_tension", diagram.over_tension);
}

void put_diagram(Value& answer, const DiagramQuestion& question, const SectionDiagram& diagram) {
  put_state(answer, question, diagram);
  Value frontiers = Value::list();
  for (const HalfPlane& plane : diagram.frontiers)
    frontiers.push_back({{"normal", Value(plane.normal)}, {"offset", plane.offset}});
  for (const Curve& curve : diagram.curves) frontiers.push_back({{"curve", points_value(curve)}});
  answer["frontiers"] = std::move(frontiers);
  if (diagram.free) answer["polygon"] = points_value(*diagram.free);
  answer["boundary"] = points_value(diagram.boundary);
  put_number(answer, "area", diagram.area);
}

/// Where the section can be after all that the one before it may do; or why that is not told.
void put_outline(SerialContext& context, const Asked& asked, const TendonsTo& commanded, std::size_t m) {
  if (asked.question.model != kernel::Model::linear) {
    context.answer["no_outline"] = "exact_model";
    return;
  }
  const std::size_t before = tendons_before(context.robot, m - 1);
  const auto count = commanded.first - before;
  // of whole tendons, but for what the lengths of sections do to them
  const double longer = asked.question.earlier.common,
               own = asked.own_extension;  // of the section, which its own tendons follow as well
  std::vector<double> changes = commanded.changes;
  for (std::size_t i = before; i < changes.size(); ++i)
    changes[i] -= longer - (i < commanded.first ? own : 0);
  DiagramQuestion question = asked.question;
  question.tendons.changes = std::span(changes).subspan(commanded.first);
  const SectionOutline outline = section_outline(
      question,
      {std::span(context.work.directions).subspan(before, count), std::span(changes).subspan(before, count)});
  if (!outline.report.ok()) return;
  constexpr std::string_view reasons[] = {"", "previous_over_tensioned", "over_tensioned", "beyond_envelope"};
  if (outline.missing == SectionOutline::Missing::none)
    context.answer["outline"] = points_value(outline.boundary);
  else
    context.answer["no_outline"] = reasons[static_cast<std::size_t>(outline.missing)];
}

/// A question of the diagram of one section.
struct SectionQuestion : SerialContext {
  using SerialContext::SerialContext;

  void read();
  void tell();

  std::size_t m = 0;
  kernel::Model model = kernel::Model::linear;
  TendonsTo commanded = {};
  std::optional<TendonsTo> measured = {};
  double tolerance = 0;
  Envelope envelope = {};
};

void SectionQuestion::read() {
  const Reader which = query.required("section", "0-based");
  m = static_cast<std::size_t>(which.integer(Range::between(0, robot.section_count() - 1)));
  model = read_tendon_model(*this, kernel::Model::linear);
  commanded = read_tendons(*this, query.required("changes", "of all sections up to it, or its own"), m);
  if (const auto list = query.optional("measured")) measured = read_tendons(*this, *list, m);
  const auto given = query.optional("tolerance");
  SerialRobot judged = robot;
  if (given) judged.tolerance = given->quantity(Dimension::length, Range::not_negative());
  tolerance = tendon_tolerance(judged);  // at least rounding
  envelope = read_envelope(*this, robot.sections[m < robot.sections.size() ? m : 0]);
}

void SectionQuestion::tell() {
  const Section& section = robot.sections[m];
  const auto diagram_of = [&](const TendonsTo& tendons, Asked& asked) {
    asked.question.section = section.map();
    asked.question.envelope = envelope;
    asked.question.tolerance = tolerance;
    asked.question.model = model;
    asked.question.tendons = {
        std::span(work.directions).subspan(tendons.first, tendons.changes.size() - tendons.first),
        std::span(tendons.changes).subspan(tendons.first)};
    put_earlier(asked, tendons);
    if (section.is_extensible()) take_extension(asked, tendons, robot, m);
    return section_diagram(asked.question);
  };
  Asked asked(*this, m);
  const SectionDiagram diagram = diagram_of(commanded, asked);
  // An earlier section beyond its limit is not where the diagram takes it; slack there is `conditional`.
  const bool is_out = asked.earlier.status == Status::left_domain;
  report(is_out && diagram.report.ok() ? asked.earlier : diagram.report);
  if (diagram.report.status == Status::left_domain) return;
  put_diagram(answer, asked.question, diagram);
  constexpr std::string_view kinds[] = {"square", "disc", "actuator"};
  answer["envelope"] = {{"kind", kinds[static_cast<std::size_t>(envelope.kind)]}, {"limit", envelope.limit}};
  answer["conditional"] = asked.is_conditional;
  if (asked.is_conditional) put_outline(*this, asked, commanded, m);
  if (measured) {
    Asked of_encoders(*this, m);
    Value state = Value::map();
    const SectionDiagram of_measured = diagram_of(*measured, of_encoders);
    if (of_measured.report.status == Status::left_domain)
      state = {{"status", "left_domain"}, {"message", std::string(of_measured.report.message.view())}};
    else
      put_state(state, of_encoders.question, of_measured);
    answer["measured"] = std::move(state);
  }
}

}  // namespace

void answer_serial_diagram(Context& context) { answer_question<SectionQuestion>(context); }

}  // namespace sinew::inline v1
