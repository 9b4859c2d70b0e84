#include "sinew/query/session.hpp"

#include <algorithm>
#include <array>

#include "query/context.hpp"
#include "sinew/io/parse.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::inline v0 {
namespace {

using Handler = void (*)(Context&);

struct Kind {
  std::string_view name;
  Handler handler;  // null: known to the protocol, not available in this version
};

constexpr std::array kinds{
    Kind{"forward", answer_forward}, Kind{"inverse", answer_inverse},   Kind{"velocity", answer_velocity},
    Kind{"shape", answer_shape},     Kind{"describe", answer_describe}, Kind{"statics", nullptr},
    Kind{"track", answer_track},     Kind{"diagram", nullptr},
};

const Kind& read_kind(Reader& query) {
  std::vector<std::string_view> names;
  for (const Kind& kind : kinds) names.push_back(kind.name);
  const Reader word =
      query.required("query", "what is asked: forward, inverse, velocity, track, shape or describe");
  const Kind& kind = kinds[word.choice_index(names)];
  if (!kind.handler) word.fail("not_available", std::string(kind.name) + " is not available in this version");
  return kind;
}

/// The query's id, which every answer repeats.
Json read_id(Reader& query) {
  const auto id = query.optional("id");
  if (!id) return {};
  if (!id->is(Node::Kind::number) && !id->is(Node::Kind::string)) {
    id->refuse("wrong_type", "give text or a number");
    return {};
  }
  if (id->is(Node::Kind::number)) return Json::parse(id->node()->text, nullptr, false);
  return id->text();
}

void read_model(Reader& query, const AnyRobot& robot) {
  const auto model = query.optional("model");
  const std::string_view own = model_of(robot);
  if (model && model->choice({"cc", "prb", "rod", "rigid"}) != own)
    model->refuse("not_available",
                  "this robot's model in this version is " + std::string(own) + std::string(meaning_of(own)));
}

std::string error_text(const Json& id, const Errors& errors) {
  Json answer = Json::object();
  if (!id.is_null()) answer["id"] = id;
  std::string message = errors.front().message;
  for (std::size_t i = 1; i < errors.size(); ++i)
    message += (message.ends_with('.') ? " " : "; ") + errors[i].message;
  answer["error"] = {{"code", errors.front().code}, {"where", errors.front().where}, {"message", message}};
  return answer.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

struct Session::State {
  Document document;
  AnyRobot robot;
  Workspace work;
};

namespace {

/// The reading of θ that a query asks for, into every drive that has one.
void choose_theta(AnyRobot& robot, const Reader& asked, ThetaIs theta_is) {
  bool found = false;
  std::visit(
      [&](auto& r) {
        for (auto& any : r.legs)
          with_leg(any, [&](auto& leg) {
            if constexpr (requires { leg.drive.theta_is; }) {
              leg.drive.theta_is = theta_is;
              found = true;
            }
          });
      },
      robot.model);
  if (!found) asked.fail("no_effect", "has no effect: no leg of this robot has an input theta; remove it");
}

/// The robot with the query's `set` and `theta_is` applied; null if it has neither, or if (with errors noted)
/// that gives no robot.
std::optional<AnyRobot> altered(const Document& document, Reader& query, Errors& errors) {
  const auto set = query.optional("set");
  const auto theta_is = query.optional("theta_is");
  if (!set && !theta_is) return {};
  if (set) set->members();  // notes it where this is no map
  const auto changed =
      with(document, set ? std::span<const Member>(set->node()->members) : std::span<const Member>());
  auto robot = changed ? read_robot(*changed) : tl::unexpected(changed.error());
  if (!robot) {
    errors.insert(errors.end(), robot.error().begin(), robot.error().end());
    return {};
  }
  if (theta_is) choose_theta(*robot, *theta_is, read_theta_is(*theta_is));
  return std::move(*robot);
}

}  // namespace

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Expected<Session> Session::open(Document document) {
  auto robot = read_robot(document);
  if (!robot) return tl::unexpected(robot.error());
  Workspace work(*robot);
  return Session(std::make_unique<State>(State{std::move(document), std::move(*robot), std::move(work)}));
}

Expected<Session> Session::open(const std::string& path) {
  auto document = read_robot_file(path);
  return document ? open(std::move(*document)) : tl::unexpected(document.error());
}

std::string Session::answer(std::string_view text) {
  const auto document = parse_json(text, "query");
  if (!document) return error_text({}, document.error());
  Errors errors;
  Reader query(*document, errors);
  const Json id = read_id(query);
  const Kind& kind = read_kind(query);
  if (!errors.empty()) return error_text(id, errors);
  read_model(query, state_->robot);
  const std::optional<AnyRobot> other = altered(state_->document, query, errors);
  if (!errors.empty()) return error_text(id, errors);
  std::optional<Workspace> other_work;
  if (other) other_work.emplace(*other);

  Json answer = Json::object();
  if (!id.is_null()) answer["id"] = id;
  answer["query"] = kind.name;
  answer["robot"] = (other ? *other : state_->robot).name;
  Context context{
      other ? *other : state_->robot, other_work ? *other_work : state_->work, query, errors, answer, {}};
  if (const auto limit = query.optional("max_iterations"))
    context.max_iterations = limit->integer(Range::between(0, 100000));
  kind.handler(context);
  if (!errors.empty()) return error_text(id, errors);
  return answer.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sinew::inline v0
