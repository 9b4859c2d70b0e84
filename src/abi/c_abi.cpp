/// The C interface over sessions: sinew.h says what it promises.
#include "sinew.h"

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>

#include "io/parse.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/query/session.hpp"

/// What `sinew_release` deletes, whatever it is.
struct sinew_object {
  sinew_object() = default;
  sinew_object(const sinew_object&) = delete;
  sinew_object& operator=(const sinew_object&) = delete;
  virtual ~sinew_object() = default;
};

struct sinew_robot : sinew_object {
  explicit sinew_robot(sinew::Document text)
      : document(std::make_shared<const sinew::Document>(std::move(text))) {}
  std::shared_ptr<const sinew::Document> document;
};

struct sinew_session : sinew_object {
  explicit sinew_session(const sinew_robot& robot) : session(sinew::Session::open(*robot.document).value()) {
    session.stop_on(sinew::StopToken(is_to_stop));
  }
  sinew::Session session;
  std::atomic<bool> is_to_stop = false;
};

namespace {

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

/// An answer where the library itself failed: in the form of all errors.
constexpr std::string_view failed_answer =
    R"({"error":{"code":"failed","where":"sinew","message":"an error of the library; please report the question"}})";

}  // namespace

std::int32_t sinew_abi() { return SINEW_ABI; }

std::int32_t sinew_open(const char* source, std::size_t size, std::int32_t kind, sinew_robot** robot,
                        char** error) {
  if (error) *error = nullptr;
  if (robot) *robot = nullptr;
  const auto refuse = [&](std::int32_t code, std::string_view why) {
    if (error) *error = given(why);
    return code;
  };
  if (!source || !robot) return refuse(SINEW_BAD_INPUT, "source and robot must not be NULL");
  try {
    auto found = opened({source, size}, kind);
    if (!found) return refuse(SINEW_BAD_INPUT, sinew::to_string(found.error()));
    *robot = found->release();
    return SINEW_OK;
  } catch (const std::bad_alloc&) {
    return refuse(SINEW_NO_MEMORY, "there is not enough memory");
  } catch (const std::exception& thrown) {
    return refuse(SINEW_FAILED, thrown.what());
  }
}

sinew_session* sinew_session_new(const sinew_robot* robot) {
  if (!robot) return nullptr;
  try {
    return new sinew_session(*robot);
  } catch (const std::exception&) {
    return nullptr;
  }
}

char* sinew_ask(sinew_session* session, const char* question, std::size_t size, std::size_t* length) {
  if (length) *length = 0;
  if (!session || !question) return nullptr;
  const auto answer = [&](std::string_view text) {
    char* copy = given(text);
    if (copy && length) *length = text.size();
    return copy;
  };
  session->is_to_stop = false;
  try {
    return answer(session->session.answer({question, size}));
  } catch (const std::bad_alloc&) {
    return nullptr;
  } catch (const std::exception&) {
    return answer(failed_answer);
  }
}

void sinew_stop(sinew_session* session) {
  if (session) session->is_to_stop = true;
}

void sinew_free(void* text) { std::free(text); }

void sinew_release(void* object) { delete static_cast<sinew_object*>(object); }
