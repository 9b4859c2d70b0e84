/// @file session.hpp
/// One request, one answer, in JSON: what the command, the server and every binding put their questions to.
/// The fields are in docs/protocol.md; typed functions (kinematics/, analysis/) do the work.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// How far a question is that takes long: a fit of `identify`.
struct QuestionProgress {
  std::string part;  ///< what is being done: `fitting`, `holding out 5 parts`
  int steps = 0;     ///< of that, so far [1]
  double error = 0;  ///< so far, root mean square of distances [m]
};

/// A robot opened for questions. Not for two threads at once: open one a thread.
class SINEW_API Session {
 public:
  /// From a robot file. All errors of the file at once.
  static Expected<Session> open(const std::string& path);
  static Expected<Session> open(Document document);

  /// One query `{"query": "forward", ...}` in, one answer out, without a line break. Never throws on bad
  /// input: the answer then is `{"error": {"code", "where", "message"}}`.
  std::string answer(std::string_view query);
  /// The same into a text, whose memory serves the next answer.
  void answer(std::string_view query, std::string& text);
  /// The same from tree to tree, for who asks and reads in this process. The limits of texts, which keep
  /// strangers harmless, do not apply: an answer may be as large as it is.
  Document answer(const Document& query);

  /// Solves that are under way end with status `stopped`, with the best they have, soon after `stop` is
  /// requested; so does every later one, until another token is given.
  void stop_on(StopToken stop);

  /// Told from now on, by the thread that asks, after each step of a question that takes long; an empty
  /// function for nobody. It must not throw, nor ask this session.
  void progress_to(std::function<void(const QuestionProgress&)> call);

  /// Forgets the pose that `"start": "last"` begins at, as for another client: the session is as when it was
  /// opened.
  void forget();

  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

 private:
  struct State;
  explicit Session(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sinew::inline v1
