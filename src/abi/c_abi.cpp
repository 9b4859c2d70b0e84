/// The C interface over sessions: sinew.h says what it promises.
#include "sinew.h"

#include <pthread.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <memory_resource>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/document/parse.hpp"
#include "query/progress.hpp"
#include "sinew/batch.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/session.hpp"
#include "sinew/solve/report.hpp"

/// What an object is, first in its memory: what is another one, or was released, is mostly noticed by it.
struct sinew_object {
  enum class Mark : std::uint64_t {  // any numbers that memory seldom has
    robot = 0x9d3a6f51c27be401,
    session = 0x9d3a6f51c27be402,
    batch = 0x9d3a6f51c27be403,
    released = 0x9d3a6f51c27be400
  };
  volatile Mark mark;  ///< volatile: what is written to it at last is written, though nobody may read it
  explicit sinew_object(Mark own) : mark(own) {}
  sinew_object(const sinew_object&) = delete;
  sinew_object& operator=(const sinew_object&) = delete;
  ~sinew_object() { mark = Mark::released; }
};

struct sinew_robot : sinew_object {
  static constexpr Mark own_mark = Mark::robot;
  explicit sinew_robot(sinew::Document text)
      : sinew_object(own_mark),
        document(std::make_shared<const sinew::Document>(std::move(text))) {}
  std::shared_ptr<const sinew::Document> document;
};

struct sinew_session : sinew_object {
  static constexpr Mark own_mark = Mark::session;
  explicit sinew_session(const sinew_robot& robot)
      : sinew_object(own_mark),
        session(sinew::Session::open(*robot.document).value()) {
    session.stop_on(sinew::StopToken(is_to_stop));
    session.progress_to([this](const sinew::QuestionProgress& now) {
      const std::scoped_lock lock(guard);
      so_far = now;
    });
  }
  /// Of the question that is answered now, if one is; from any thread.
  std::string progress() {
    const std::scoped_lock lock(guard);
    return sinew::progress_json(is_busy, so_far).dump();
  }
  void set_busy(bool is) {
    const std::scoped_lock lock(guard);
    is_busy = is;
    so_far.reset();
  }
  sinew::Session session;
  std::string text;  ///< of the answer last written
  std::atomic<bool> is_to_stop = false;
  std::mutex guard;  ///< of what follows
  bool is_busy = false;
  std::optional<sinew::QuestionProgress> so_far = {};
};

/// While it lives a question is answered.
struct BusySession {
  explicit BusySession(sinew_session& session) : session_(session) { session_.set_busy(true); }
  BusySession(const BusySession&) = delete;
  BusySession& operator=(const BusySession&) = delete;
  ~BusySession() { session_.set_busy(false); }

 private:
  sinew_session& session_;
};

struct sinew_batch : sinew_object {
  static constexpr Mark own_mark = Mark::batch;
  explicit sinew_batch(sinew::Batch prepared) : sinew_object(own_mark), batch(std::move(prepared)) {}
  sinew::Batch batch;
  std::atomic<bool> is_to_stop = false;
  std::atomic<int> running = 0;
};

namespace {

template <class Object>
bool is_one(const Object* object) {
  return object && object->mark == Object::own_mark;
}
/// Calls `use` with what an object is; not at all with what is none.
template <class Use>
void with(void* object, const Use& use) {
  if (!object) return;
  switch (static_cast<sinew_object*>(object)->mark) {
    case sinew_object::Mark::robot:
      return use(static_cast<sinew_robot*>(object));
    case sinew_object::Mark::session:
      return use(static_cast<sinew_session*>(object));
    case sinew_object::Mark::batch:
      return use(static_cast<sinew_batch*>(object));
    case sinew_object::Mark::released:
      return;
  }
}

/// While it lives the thread is not cancelled: that would unwind it through functions that end the process
/// then. It is cancelled at the next chance after that.
class WithoutCancellation {
 public:
  WithoutCancellation() { pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &before_); }
  WithoutCancellation(const WithoutCancellation&) = delete;
  WithoutCancellation& operator=(const WithoutCancellation&) = delete;
  ~WithoutCancellation() { pthread_setcancelstate(before_, nullptr); }

 private:
  int before_ = PTHREAD_CANCEL_ENABLE;
};

/// A copy of a text for whoever called; null where there is no memory.
char* given(std::string_view text) noexcept {
  auto* copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (!copy) return nullptr;
  std::memcpy(copy, text.data(), text.size());
  copy[text.size()] = '\0';
  return copy;
}

sinew::Expected<sinew::Document> read(std::string_view source, std::int32_t kind) {
  if (kind == SINEW_FILE) return sinew::read_robot_file(std::string(source));
  if (kind == SINEW_TEXT) return sinew::parse_yaml(source, "robot");
  return sinew::failure("out_of_range", "kind", "kind is SINEW_FILE or SINEW_TEXT");
}

sinew::Expected<std::unique_ptr<sinew_robot>> opened(std::string_view source, std::int32_t kind) {
  auto document = read(source, kind);
  if (!document) return tl::unexpected(document.error());
  if (const auto robot = sinew::read_robot(*document); !robot) return tl::unexpected(robot.error());
  return std::make_unique<sinew_robot>(std::move(*document));
}

/// Calls `use(why)`, whatever it throws; a text in `why` goes to whoever called.
template <class Use>
std::int32_t guarded(char** error, const Use& use) noexcept {
  const WithoutCancellation whole;
  if (error) *error = nullptr;
  const auto say = [&](std::string_view why) {
    if (error && !why.empty()) *error = given(why);
  };
  try {
    std::string why;
    const std::int32_t code = use(why);
    say(why);
    return code;
  } catch (const std::bad_alloc&) {
    say("there is not enough memory");
    return SINEW_NO_MEMORY;
  } catch (const std::exception& thrown) {
    say(thrown.what());
    return SINEW_FAILED;
  }
}

/// Whether that asks how far the session is, and nothing else: such a question is answered at once.
bool asks_progress(std::string_view question) {
  constexpr std::size_t most = 200;  // others are parsed but once
  if (question.size() > most || question.find("progress") == std::string_view::npos) return false;
  const auto document = sinew::parse_json(question, "query");
  if (!document || document->root.members.size() != 1) return false;
  const sinew::Node* kind = document->root.find("query");
  return kind && kind->kind == sinew::Node::Kind::string && kind->text == "progress";
}

/// An answer where the library itself failed: in the form of all errors.
constexpr std::string_view failed_answer =
    R"({"error":{"code":"failed","where":"sinew","message":"an error of the library; please report the question"}})";

}  // namespace

std::int32_t sinew_abi() { return SINEW_ABI; }

std::int32_t sinew_open(const char* source, std::size_t size, std::int32_t kind, sinew_robot** robot,
                        char** error) {
  if (robot) *robot = nullptr;
  return guarded(error, [&](std::string& why) {
    if (!source || !robot) {
      why = "source and robot must not be NULL";
      return SINEW_BAD_INPUT;
    }
    auto found = opened({source, size}, kind);
    if (!found) {
      why = sinew::to_string(found.error());
      return SINEW_BAD_INPUT;
    }
    *robot = found->release();
    return SINEW_OK;
  });
}

sinew_session* sinew_session_new(const sinew_robot* robot) {
  if (!is_one(robot)) return nullptr;
  const WithoutCancellation whole;
  try {
    return new sinew_session(*robot);
  } catch (const std::exception&) {
    return nullptr;
  }
}

char* sinew_ask(sinew_session* session, const char* question, std::size_t size, std::size_t* length) {
  if (length) *length = 0;
  if (!is_one(session) || !question) return nullptr;
  const WithoutCancellation whole;
  const auto answer = [&](std::string_view text) {
    char* copy = given(text);
    if (copy && length) *length = text.size();
    return copy;
  };
  try {
    if (asks_progress({question, size})) return answer(session->progress());
    session->is_to_stop = false;
    const BusySession busy(*session);
    session->session.answer({question, size}, session->text);
    return answer(session->text);
  } catch (const std::bad_alloc&) {
    return nullptr;
  } catch (const std::exception&) {
    return answer(failed_answer);
  }
}

std::int32_t sinew_prepare(const sinew_robot* robot, const char* question, std::size_t size,
                           sinew_batch** batch, char** error) {
  if (batch) *batch = nullptr;
  return guarded(error, [&](std::string& why) {
    if (!is_one(robot) || !question || !batch) {
      why = "robot, question and batch must not be NULL, and robot one that is open";
      return SINEW_BAD_INPUT;
    }
    const auto asked = sinew::parse_json({question, size}, "query");
    auto prepared = asked ? sinew::Batch::prepare(*robot->document, *asked) : tl::unexpected(asked.error());
    if (!prepared) {
      why = sinew::to_string(prepared.error());
      return SINEW_BAD_INPUT;
    }
    *batch = new sinew_batch(std::move(*prepared));
    return SINEW_OK;
  });
}

char* sinew_fields(const sinew_batch* batch) {
  if (!is_one(batch)) return nullptr;
  const WithoutCancellation whole;
  try {
    const auto fields = [](std::span<const sinew::Batch::Field> all) {
      nlohmann::ordered_json list = nlohmann::ordered_json::array();
      for (const auto& [name, unit, shape] : all)
        list.push_back({{"name", name}, {"unit", unit}, {"rank", shape.size()}, {"shape", shape}});
      return list;
    };
    return given(nlohmann::ordered_json{{"inputs", fields(batch->batch.inputs())},
                                        {"outputs", fields(batch->batch.outputs())},
                                        {"want", batch->batch.wants()},
                                        {"method", batch->batch.method()}}
                     .dump());
  } catch (const std::exception&) {
    return nullptr;
  }
}

namespace {

using In = std::pmr::vector<sinew::Batch::Strided<const double>>;
using Out = std::pmr::vector<sinew::Batch::Strided<double>>;

/// What whoever called should know of rows that were computed; mostly nothing.
std::string oddity(const sinew::Batch& batch, const In& in, const Out& out,
                   std::span<const std::uint8_t> statuses) {
  const auto first = [&](sinew::Status status) {
    return static_cast<std::size_t>(std::ranges::find(statuses, static_cast<std::uint8_t>(status)) -
                                    statuses.begin());
  };
  const auto answer = [&](std::size_t row) {
    std::vector<double> numbers;
    for (std::size_t f = 0; f < in.size(); ++f)
      for (std::size_t i = 0; i < batch.inputs()[f].size(); ++i) numbers.push_back(in[f](row, i));
    return batch.answer(numbers);
  };
  const auto message = [&](const std::string& of_row) {
    return nlohmann::json::parse(of_row).value("message", "the robot has no answer");
  };
  if (const std::size_t bad = first(sinew::Status::bad_input); bad < statuses.size()) {
    const std::string of_row =
        answer(bad);  // of numbers that a typed question takes, such as infinity, a status
    return of_row.starts_with(R"({"error")") ? of_row : message(of_row);
  }
  if (const std::size_t lacking = first(sinew::Status::unsupported); lacking < statuses.size())
    return message(answer(lacking));
  const auto solved = static_cast<std::uint8_t>(sinew::Status::converged);
  if (std::ranges::find(statuses, solved) == statuses.end()) return {};
  for (std::size_t f = 0; f < out.size(); ++f) {
    const auto is_there = [&](std::size_t row) {
      for (std::size_t i = 0; i < batch.outputs()[f].size(); ++i)
        if (!std::isnan(out[f](row, i))) return true;
      return false;
    };
    std::size_t row = 0;
    while (row < statuses.size() && (statuses[row] != solved || !is_there(row))) ++row;
    if (row == statuses.size())
      return "outputs." + batch.outputs()[f].name + ": no row that is solved has a number there";
  }
  return {};
}

}  // namespace

std::int32_t sinew_run(sinew_batch* batch, std::size_t rows, const sinew_input* inputs,
                       const sinew_output* outputs, std::uint8_t* statuses, std::int32_t threads,
                       char** error) {
  return guarded(error, [&](std::string& why) {
    if (!is_one(batch) || !inputs || !outputs) {
      why = "batch, inputs and outputs must not be NULL, and batch one that was prepared";
      return SINEW_BAD_INPUT;
    }
    std::array<std::byte, 1024> room;  // of a few fields, so that a row by itself allocates nothing
    std::pmr::monotonic_buffer_resource fields(room.data(), room.size());
    In in(&fields);
    Out out(&fields);
    for (std::size_t i = 0; i < batch->batch.inputs().size(); ++i)
      in.push_back({inputs[i].data, inputs[i].stride, inputs[i].step});
    for (std::size_t o = 0; o < batch->batch.outputs().size(); ++o)
      out.push_back({outputs[o].data, outputs[o].stride, outputs[o].step});
    const auto is_null = [](const auto& field) { return !field.data; };
    if (rows > 0 && (std::ranges::any_of(in, is_null) || std::ranges::any_of(out, is_null))) {
      why = "the data of a field is NULL";
      return SINEW_BAD_INPUT;
    }
    std::vector<std::uint8_t> own(statuses || !error ? 0 : rows);
    const std::span<std::uint8_t> all = statuses ? std::span(statuses, rows) : own;
    if (batch->running++ == 0) batch->is_to_stop = false;
    const auto end = [&] { --batch->running; };
    try {
      batch->batch.run(rows, in, out, all, {.threads = threads, .stop = &batch->is_to_stop});
    } catch (...) {
      end();
      throw;
    }
    end();
    if (error) why = oddity(batch->batch, in, out, all);
    return SINEW_OK;
  });
}

void sinew_stop(void* object) {
  with(object, [](auto* one) {
    if constexpr (requires { one->is_to_stop; }) one->is_to_stop = true;
  });
}

void sinew_free(void* text) { std::free(text); }

void sinew_release(void* object) {
  const WithoutCancellation whole;
  with(object, [](auto* one) { delete one; });
}
