// Queries to every robot that comes with sinew. An input is the name of a robot file's stem on a line, then
// queries, a line each, which one session answers in turn. Mutations keep the JSON whole, but for one in a
// few: they change what stands in it.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <sstream>
#include <thread>

#include "check.hpp"
#include "driver.hpp"
#include "paths.hpp"
#include "sinew/session.hpp"

namespace {

using namespace sinew;
using fuzz::below;
using fuzz::Random;
using Json = nlohmann::ordered_json;

/// Asks a session to stop when a question takes long, as a client that goes away does.
class Deadline {
 public:
  Deadline() : thread_([this] { watch(); }) { thread_.detach(); }  // it ends with the process
  StopToken token() const { return StopToken(flag_); }
  void start() {
    const std::lock_guard lock(mutex_);
    flag_ = false;
    until_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
    changed_.notify_one();
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    until_.reset();
  }

 private:
  void watch() {
    std::unique_lock lock(mutex_);
    while (true) {
      if (!until_)
        changed_.wait(lock);
      else if (std::chrono::steady_clock::now() >= *until_)
        flag_ = true, until_.reset();
      else
        changed_.wait_until(lock, *until_);
    }
  }
  std::atomic<bool> flag_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::chrono::steady_clock::time_point> until_;
  std::thread thread_;
};

struct World {
  std::map<std::string, Session> sessions;
  Deadline deadline;
  World() {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(test::source_folder) + "/robots")) {
      auto session = Session::open(entry.path().string());
      if (!session) fuzz::die("a robot that cannot be read", to_string(session.error()));
      session->stop_on(deadline.token());
      sessions.emplace(entry.path().stem().string(), std::move(*session));
    }
  }
};

/// Fields of all queries, and words that may stand in them.
constexpr std::string_view fields[] = {"id",
                                       "query",
                                       "model",
                                       "set",
                                       "theta_is",
                                       "max_iterations",
                                       "tilt",
                                       "inputs",
                                       "start",
                                       "trace",
                                       "all",
                                       "want",
                                       "wrench",
                                       "until",
                                       "gravity",
                                       "pose",
                                       "independent",
                                       "bending",
                                       "curvature",
                                       "elbow",
                                       "twist",
                                       "rates",
                                       "along",
                                       "limit",
                                       "angles",
                                       "samples",
                                       "from",
                                       "to",
                                       "poses",
                                       "objective",
                                       "law",
                                       "rk4_steps",
                                       "set_at",
                                       "hold",
                                       "tensions",
                                       "lengths",
                                       "inverse",
                                       "posture_threshold",
                                       "axial_forces",
                                       "deviation",
                                       "range",
                                       "backward",
                                       "branches",
                                       "configuration",
                                       "changes",
                                       "slack",
                                       "position",
                                       "direction",
                                       "section",
                                       "measured",
                                       "tolerance",
                                       "envelope",
                                       "x",
                                       "y",
                                       "phi",
                                       "quaternion",
                                       "azimuth",
                                       "torsion",
                                       "z",
                                       "e1",
                                       "e2",
                                       "mode",
                                       "legs[0].link.length",
                                       "platform.radius",
                                       "sections[0].segments",
                                       "defaults.link"};
constexpr std::string_view texts[] = {
    "forward",  "inverse",  "velocity",  "statics",   "track",       "diagram",     "shape", "describe",
    "identify", "cc",       "prb",       "rod",       "rigid",       "pcc",         "lsk",   "last",
    "tangent",  "chord",    "stiffness", "stability", "margins",     "sensitivity", "M0",    "M0w",
    "M1",       "tension",  "length",    "limits",    "singularity", "smooth",      "none",  "square",
    "disc",     "actuator", "half_turn", "tilt",      "10 mm",       "10 deg",      "1 N",   "1 N mm",
    "10 kg",    "",         "\u00e9",    "nan",       "1e999",       "1/0"};

Json any_value(Random& random) {
  switch (below(random, 12)) {
    case 0:
      return nullptr;
    case 1:
      return random() % 2 == 0;
    case 2:
      return texts[below(random, std::size(texts))];
    case 3:
      return Json::array();
    case 4:
      return Json::object();
    case 5: {
      Json list = Json::array();
      for (std::size_t k = below(random, 8); k > 0; --k) list.push_back(any_value(random));
      return list;
    }
    case 6: {
      Json deep = 1;
      for (std::size_t k = below(random, 80); k > 0; --k) deep = Json::array({deep});
      return deep;
    }
    case 7:
      return Json{{fields[below(random, std::size(fields))], any_value(random)}};
    case 8:
      return std::ldexp(static_cast<double>(random()) / 1e19, static_cast<int>(below(random, 40)) - 20);
    default: {
      const std::string number(fuzz::odd_numbers[below(random, std::size(fuzz::odd_numbers))]);
      return Json::parse(number, nullptr, false).is_discarded() ? Json(number)
                                                                : Json::parse(number, nullptr, false);
    }
  }
}

/// Every value of a tree, the tree itself last.
void collect(Json& json, std::vector<Json*>& nodes) {
  if (json.is_structured())
    for (Json& part : json) collect(part, nodes);
  nodes.push_back(&json);
}

void mutate(Json& query, Random& random) {
  std::vector<Json*> nodes;
  collect(query, nodes);
  Json& node = *nodes[below(random, nodes.size())];
  switch (below(random, 6)) {
    case 0:
      if (node.is_structured() && !node.empty()) {
        auto part = node.begin();
        std::advance(part, static_cast<std::ptrdiff_t>(below(random, node.size())));
        node.erase(part);
      }
      break;
    case 1:
      if (node.is_array() && node.size() < 64)
        node.push_back(node.empty() || random() % 2 ? any_value(random) : node.front());
      break;
    case 2:
      if (query.is_object()) query[std::string(fields[below(random, std::size(fields))])] = any_value(random);
      break;
    case 3:
      if (node.is_number())
        node = node.get<double>() *
               (random() % 2 ? -1 : std::ldexp(1.0, static_cast<int>(below(random, 24)) - 12));
      break;
    case 4:
      node = Json(*nodes[below(random, nodes.size())]);
      break;
    default:
      node = any_value(random);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed) {
  Random random(seed);
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  if (lines.size() < 2) return size;
  const std::size_t chosen = 1 + below(random, lines.size() - 1);
  Json query = Json::parse(lines[chosen], nullptr, false);
  if (query.is_discarded()) return size;
  mutate(query, random);
  std::string line = query.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (query.is_object() && !query.empty() && below(random, 16) == 0)  // a key twice
    line = "{" + Json(query.begin().key()).dump() + ":1," + line.substr(1);
  std::string text = lines[0] + '\n' + line;  // one query: others of the input would only hide it
  if (random() % 4 == 0)
    for (std::size_t k = 1; k < lines.size(); ++k) text += '\n' + lines[k];
  if (text.size() > most) return size;
  std::copy(text.begin(), text.end(), data);
  return text.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static World world;
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  std::string name, line;
  std::getline(stream, name);
  auto found = world.sessions.find(name);
  if (found == world.sessions.end()) {
    found = world.sessions.begin();
    std::advance(found, static_cast<std::ptrdiff_t>(size % world.sessions.size()));
  }
  Session& session = found->second;
  session.forget();
  for (int count = 0; count < 16 && std::getline(stream, line); ++count) {
    world.deadline.start();
    const std::string answer = session.answer(line);
    world.deadline.clear();
    fuzz::check_answer(answer);
  }
  return 0;
}

SINEW_FUZZ_MAIN("session", texts)
