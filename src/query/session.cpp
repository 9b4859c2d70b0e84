#include "sinew/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/document/reader.hpp"
#include "io/robots/actuation.hpp"
#include "query/batch/row_places.hpp"
#include "query/batch/sampler.hpp"
#include "query/fields/fields.hpp"
#include "query/handlers.hpp"
#include "query/tree_session.hpp"
#include "query/unit_hint.hpp"
#include "robot/parallel.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/robot/arm_legs.hpp"
#include "tendon/theta_is.hpp"

namespace sinew::inline v1 {
namespace {

const Handlers& handlers_of(const Robot& robot) {
  if (robot.serial()) return serial_handlers;
  if (robot.arm()) return arm_handlers;
  if (robot.arm_legs()) return arm_legs_handlers;
  if (has_rods(robot)) return rod_handlers;
  return robot.model() == Model::prb ? chain_handlers : kinematic_handlers;
}

bool has_platform_on_legs(const Robot& robot) { return !robot.serial() && !robot.arm() && !robot.arm_legs(); }

/// By some model.
bool is_of_platforms(Ask ask) {
  return kinematic_handlers.of(ask) || chain_handlers.of(ask) || rod_handlers.of(ask);
}
/// Whether it is of what bears loads alone.
bool is_of_loads(Ask ask) { return chain_handlers.of(ask) && !kinematic_handlers.of(ask); }
/// Whether it is to an arm as a serial robot: lengths of tendons give its shape.
bool is_of_lengths(Ask ask, const Robot& robot, std::string_view model) {
  return robot.arm() && (!arm_handlers.of(ask) || model == "pcc" || model == "lsk");
}

/// Why a robot has no answer to any question of a kind; nothing where it has.
std::optional<std::string> lack_of(Ask ask, const Robot& robot, std::string_view model) {
  if (is_of_lengths(ask, robot, model)) {
    if (serial_handlers.of(ask)) return {};
    return fmt::format(
        "{} is not available by the models pcc and lsk, of which tendons' lengths give the shape; leave "
        "model "
        "out, or give another one",
        word_of(ask));
  }
  const bool is_platform = has_platform_on_legs(robot);
  if (is_platform ? is_of_platforms(ask) : handlers_of(robot).of(ask) != nullptr) return {};
  if (!serial_handlers.of(ask) && !is_of_platforms(ask))
    return fmt::format("{} is a question to arms that bear loads", word_of(ask));
  if (is_platform) return fmt::format("{} is a question to serial robots", word_of(ask));
  return fmt::format("{} is not available of {} in this version", word_of(ask), handlers_of(robot).robots);
}

/// @param model the word of it, as it is asked
Ask read_ask(Reader& query, const Robot& robot, std::string_view model) {
  static const std::string meaning = fmt::format("what is asked: {}", fmt::join(ask_words, ", "));
  const Reader word = query.required("query", meaning);
  const auto ask = static_cast<Ask>(word.choice_index(ask_words));
  if (const auto lack = lack_of(ask, robot, model)) word.fail("not_available", *lack);
  return ask;
}

/// The query's id, which every answer repeats.
Value read_id(Reader& query) {
  const auto id = query.optional("id");
  if (!id) return {};
  if (!id->is(Node::Kind::number) && !id->is(Node::Kind::string)) {
    id->refuse("wrong_type", "give text or a number");
    return {};
  }
  if (!id->is(Node::Kind::number)) return id->text();
  if (nlohmann::json::accept(id->node()->text)) return Value::Written{id->node()->text};
  return id->number();
}

std::string_view meaning_of(Model model) {
  constexpr std::string_view meanings[] = {"cc (constant curvature), or prb (pseudo-rigid chains)",
                                           "prb (pseudo-rigid chains)", "rod (elastic rods)",
                                           "rigid (rigid links)"};
  return meanings[static_cast<std::size_t>(model)];
}

/// How a query wants the robot's links to be taken. `statics` is of links that yield.
struct ModelQuery {
  Model model;
  PrbDiscretisation discretisation = PrbDiscretisation::weighted;
};
ModelQuery read_model(Reader& query, const std::optional<Reader>& word, const Robot& robot, Ask ask) {
  const bool needs_load = is_of_loads(ask) && !bears_load(robot);
  ModelQuery asked{needs_load ? Model::prb : robot.model()};
  if (word) {
    asked.model = word->choice_of<Model>(
        {{"cc", Model::cc}, {"prb", Model::prb}, {"rod", Model::rod}, {"rigid", Model::rigid}});
    if (asked.model != robot.model() && !(asked.model == Model::prb && robot.model() == Model::cc))
      word->refuse("not_available", fmt::format("this robot's model is {}", meaning_of(robot.model())));
    else if (needs_load && asked.model != Model::prb)
      word->refuse("not_available", "a load needs links that yield: give prb, or leave model out");
  }
  if (asked.model != Model::prb) return asked;
  if (const auto law = query.optional("law"))
    asked.discretisation = law->choice_of<PrbDiscretisation>({{"M0w", PrbDiscretisation::weighted},
                                                              {"M0", PrbDiscretisation::even},
                                                              {"M1", PrbDiscretisation::discs}});
  return asked;
}

/// What an arm is described as: a serial robot by pcc and lsk, else itself.
void read_arm_word(Reader& query) {
  if (const auto word = query.optional("model"))
    word->choice({"pcc", "lsk", "rod", "subsegment_rod", "subsegment_cc", "cc", "prb"});
}

bool has_key(const Document& robot, std::string_view key) {
  const Node* value = robot.root.find(key);
  return value && value->kind != Node::Kind::null;
}

std::string message_of(const Errors& errors) {
  std::string message = errors.front().message;
  for (std::size_t i = 1; i < errors.size(); ++i)
    message += (message.ends_with('.') ? " " : "; ") + errors[i].message;
  return message;
}

Value error_answer(const Value& id, const Errors& errors) {
  Value answer = Value::map();
  if (!id.is_null()) answer["id"] = id;
  answer["error"] = {
      {"code", errors.front().code}, {"where", errors.front().where}, {"message", message_of(errors)}};
  return answer;
}

/// Errors that are all `not_available` become the status `unsupported`; with any other they are an error.
Value refusal(const Value& id, Ask ask, const Robot& robot, const Errors& errors) {
  const auto is_lacking = [](const Error& error) { return error.code == "not_available"; };
  if (!std::ranges::all_of(errors, is_lacking)) return error_answer(id, errors);
  Value answer = Value::map();
  if (!id.is_null()) answer["id"] = id;
  answer["query"] = word_of(ask);
  answer["robot"] = robot.name();
  answer["status"] = to_string(Status::unsupported);
  answer["message"] = message_of(errors);
  return answer;
}

/// A robot, and the memory for questions to it.
struct Opened {
  Robot robot;
  Workspace work;
  RobotScale scale;
  std::vector<InputOfLeg> inputs;
  std::array<std::unique_ptr<Opened>, 3>
      on_chains;                            ///< the same by the model prb, by discretisation, once asked
  std::unique_ptr<Opened> of_lengths = {};  ///< an arm as a serial robot, once asked
  explicit Opened(const Robot& any)
      : robot(any),
        work(robot),
        scale(scale_of(robot)),
        inputs(inputs_of(robot)) {}

  /// By the model that is asked for; null, with errors noted, where it has none.
  Opened* by(const ModelQuery& asked, Errors& errors) {
    const bool is_of_lengths = robot.arm() && asked.model == Model::cc;
    if (!is_of_lengths && (asked.model != Model::prb || robot.model() == Model::prb)) return this;
    auto& own = is_of_lengths ? of_lengths : on_chains[static_cast<std::size_t>(asked.discretisation)];
    if (own) return own.get();
    const auto view = robot.as(asked.model, asked.discretisation);
    if (!view) {
      errors.insert(errors.end(), view.error().begin(), view.error().end());
      return nullptr;
    }
    own = std::make_unique<Opened>(*view);
    return own.get();
  }
};
Expected<Opened> open_robot(const Document& document) {
  return read_robot(document).map([](const Robot& robot) { return Opened(robot); });
}

}  // namespace

struct TreeSession::State {
  std::shared_ptr<const Document> document;
  Opened opened;
  StopToken stop = {};
  ProgressCall progress = {};
  /// The robot that the last query asked about which changed it: the next one often changes it alike.
  struct Altered {
    Node set, theta_is;  ///< as it was asked
    Opened opened;
  };
  std::optional<Altered> kept = {};

  /// The robot with the query's `set` and `theta_is` applied; null if it has neither, or if (with errors
  /// noted) that gives no robot.
  Opened* altered(Reader& query, Errors& errors);
};
struct Session::State {
  TreeSession session;
  std::optional<AnyPose> last = {};
};

namespace {

/// The robot with the reading of θ that a query asks for in every drive that has one.
void choose_theta(Opened& opened, const Reader& asked, ThetaIs theta_is) {
  bool found = false;
  const auto choose = [&](auto& leg) {
    if constexpr (requires { leg.drive.theta_is; }) {
      leg.drive.theta_is = theta_is;
      found = true;
    }
  };
  if (has_platform_on_legs(opened.robot)) opened = Opened(with_changed_legs(opened.robot, choose));
  if (!found) asked.fail("no_effect", "has no effect: no leg of this robot has an input theta; remove it");
}

/// Whether the answer's poses are to have tilt, azimuth and torsion.
bool read_tilt(Reader& query, const Opened& opened) {
  const auto asked = query.optional("tilt");
  const bool is_wanted = asked && asked->boolean();
  const ArmLegs* legs = opened.robot.arm_legs();
  if (is_wanted && (opened.robot.planar() || (legs && legs->is_planar)))
    asked->fail("no_effect", "has no effect: in the plane phi says how the platform is turned; remove it");
  return is_wanted;
}

/// What these robots lack of what others have. Only what is asked for becomes a field of the question.
void refuse_lacking(Reader& query, const Handlers& handlers) {
  for (const auto& [field, why] : handlers.lacks)
    if (query.node()->find(field))
      if (const auto given = query.optional(field)) given->fail("not_available", why);
}

/// Whether two nodes say the same, wherever they stand.
bool is_same(const Node& a, const Node& b) {
  return a.kind == b.kind && a.boolean == b.boolean && a.number == b.number && a.text == b.text &&
         std::ranges::equal(a.items, b.items, is_same) &&
         std::ranges::equal(a.members, b.members, [](const Member& one, const Member& other) {
           return one.key == other.key && is_same(one.value, other.value);
         });
}

}  // namespace

Opened* TreeSession::State::altered(Reader& query, Errors& errors) {
  const auto set = query.optional("set");
  const auto theta_is = query.optional("theta_is");
  if (!set && !theta_is) return nullptr;
  if (set) set->members();  // notes it where this is no map
  const Node settings = set ? *set->node() : Node{}, theta = theta_is ? *theta_is->node() : Node{};
  if (errors.empty() && kept && is_same(kept->set, settings) && is_same(kept->theta_is, theta))
    return &kept->opened;
  kept.reset();
  const auto changed = with(*document, settings.members);
  auto robot = changed ? open_robot(*changed) : tl::unexpected(changed.error());
  if (!robot) {
    errors.insert(errors.end(), robot.error().begin(), robot.error().end());
    return nullptr;
  }
  const Robot &before = opened.robot, &after = robot->robot;
  if (!before.serial() != !after.serial() || !before.arm() != !after.arm() ||
      !before.arm_legs() != !after.arm_legs()) {
    set->fail("wrong_kind", "it makes a robot of another kind; put the question to a file of that robot");
    return nullptr;
  }
  if (theta_is) choose_theta(*robot, *theta_is, read_theta_is(*theta_is));
  if (!errors.empty()) return nullptr;
  kept.emplace(Altered{settings, theta, std::move(*robot)});
  return &kept->opened;
}

TreeSession::TreeSession(std::unique_ptr<State> state) : state_(std::move(state)) {}
TreeSession::TreeSession(TreeSession&&) noexcept = default;
TreeSession& TreeSession::operator=(TreeSession&&) noexcept = default;
TreeSession::~TreeSession() = default;

Expected<TreeSession> TreeSession::open(Document robot) {
  auto opened = open_robot(robot);
  if (!opened) return tl::unexpected(opened.error());
  return TreeSession(
      std::make_unique<State>(State{std::make_shared<const Document>(std::move(robot)), std::move(*opened)}));
}

TreeSession TreeSession::anew() const {
  return TreeSession(
      std::make_unique<State>(State{state_->document, Opened(state_->opened.robot), state_->stop}));
}

Value TreeSession::answer(const Document& query, std::optional<AnyPose>* last, Continues continues) {
  Errors errors;
  return put(query, last, continues, false, errors);
}

Errors TreeSession::errors_of(const Document& query) {
  Errors errors;
  put(query, nullptr, Continues::always, true, errors);
  return errors;
}

/// A question as far as it is read alike whatever it is put to.
struct TreeSession::Begun {
  Value id;
  Ask ask = Ask::forward;
  Opened* opened = nullptr;  ///< what it is put to; null where it is refused
  std::optional<int> max_iterations;
  bool wants_tilt = false;
  Value refused;  ///< the answer then

  const Handlers& handlers() const { return handlers_of(opened->robot); }
};

TreeSession::Begun TreeSession::begin(const Document& document, Reader& query, Errors& errors) {
  Begun begun{.id = read_id(query), .max_iterations = {}, .refused = {}};
  const Robot& own = state_->opened.robot;
  const bool has_platform = has_platform_on_legs(own);
  const Node* word = document.root.find("model");
  const std::string_view asked_model = word ? std::string_view(word->text) : std::string_view();
  const auto refused = [&](const Robot& robot) -> Begun& {
    begun.opened = nullptr;
    begun.refused = refusal(begun.id, begun.ask, robot, errors);
    return begun;
  };
  begun.ask = read_ask(query, own, asked_model);
  if (!errors.empty()) return refused(own);
  const auto model = has_platform ? query.optional("model") : std::nullopt;  // else the handler's
  Opened* opened = state_->altered(query, errors);
  if (!errors.empty()) {
    begun.refused = error_answer(begun.id, errors);
    return begun;
  }
  if (!opened) opened = &state_->opened;
  const Robot& asked = opened->robot;
  if (has_platform) opened = opened->by(read_model(query, model, asked, begun.ask), errors);
  if (is_of_lengths(begun.ask, asked, asked_model)) opened = opened->by({Model::cc}, errors);
  if (asked.arm() && begun.ask == Ask::describe) read_arm_word(query);
  if (!errors.empty()) return refused(asked);
  begun.opened = opened;
  if (const auto limit = query.optional("max_iterations"))
    begun.max_iterations = limit->integer(Range::between(0, 100000));
  begun.wants_tilt = read_tilt(query, *opened);
  refuse_lacking(query, begun.handlers());
  opened->work.stop = state_->stop;
  return begun;
}

/// @param is_only_read the answer stays empty; @param errors all that reading the question finds
Value TreeSession::put(const Document& document, std::optional<AnyPose>* last, Continues continues,
                       bool is_only_read, Errors& errors) {
  Reader query(document, errors);
  Begun begun = begin(document, query, errors);
  if (!begun.opened) return std::move(begun.refused);
  const Robot& robot = begun.opened->robot;

  Value answer = Value::map();
  if (!begun.id.is_null()) answer["id"] = begun.id;
  answer["query"] = word_of(begun.ask);
  answer["robot"] = robot.name();
  Question question{query, errors,   answer, begun.handlers(), begun.ask, begun.max_iterations,
                    last,  continues};
  question.is_only_read = is_only_read;
  question.progress = &state_->progress;
  Context context{question, robot, begun.opened->work};
  begun.handlers().of(begun.ask)(context);
  if (!errors.empty()) return refusal(begun.id, begun.ask, robot, errors);
  if (is_only_read) return answer;
  if (begun.wants_tilt) add_tilt(answer);
  if (robot.serial() && answer.text_at("status") == "slack" && !has_key(*state_->document, "tolerance"))
    answer["message"] =
        fmt::format("{}; the file gives no tolerance of its tendons: {} counts", answer.text_at("message"),
                    human(robot.serial()->tolerance, Dimension::length));
  const Opened& own = state_->opened;  // the robot as its file has it
  const std::string hint = unit_hint(document.root, answer, own.scale, state_->document->root, own.inputs);
  if (!hint.empty()) {
    std::string said(answer.text_at("message"));
    while (said.ends_with('.')) said.pop_back();
    answer["message"] = said.empty() ? hint : said + ". " + hint;
  }
  return answer;
}

SamplerKind TreeSession::plan(const RowPlaces& rows) {
  Errors errors;
  Reader query(rows.trial(), errors);
  const Begun begun = begin(rows.trial(), query, errors);
  if (!begun.opened || begun.wants_tilt || !begun.handlers().plan) return {};
  Value answer;
  Question question{query, errors, answer, begun.handlers(), begun.ask, begun.max_iterations};
  Context context{question, begun.opened->robot, begun.opened->work};
  return begun.handlers().plan(context, rows);
}

void TreeSession::stop_on(StopToken stop) { state_->stop = stop; }

void TreeSession::progress_to(ProgressCall call) { state_->progress = std::move(call); }

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Expected<Session> Session::open(Document document) {
  auto session = TreeSession::open(std::move(document));
  if (!session) return tl::unexpected(session.error());
  return Session(std::make_unique<State>(State{std::move(*session)}));
}

Expected<Session> Session::open(const std::string& path) {
  auto document = read_robot_file(path);
  return document ? open(std::move(*document)) : tl::unexpected(document.error());
}

void Session::answer(std::string_view query, std::string& text) {
  const auto document = parse_json(query, "query");
  const Value answer = document ? state_->session.answer(*document, &state_->last, Continues::where_asked)
                                : error_answer({}, document.error());
  text.clear();
  answer.append_json(text);
}

std::string Session::answer(std::string_view query) {
  std::string text;
  answer(query, text);
  return text;
}

Document Session::answer(const Document& query) {
  return {"answer", state_->session.answer(query, &state_->last, Continues::where_asked).node()};
}

void Session::stop_on(StopToken stop) { state_->session.stop_on(stop); }

void Session::progress_to(ProgressCall call) { state_->session.progress_to(std::move(call)); }

void Session::forget() { state_->last.reset(); }

}  // namespace sinew::inline v1
