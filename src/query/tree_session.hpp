/// @file tree_session.hpp
/// A session whose questions and answers stay trees: what asks millions of them spares their texts.
#pragma once
#include <memory>
#include <optional>

#include "io/document/reader.hpp"
#include "query/context.hpp"

namespace sinew::inline v1 {

class RowPlaces;
struct SamplerKind;

/// As Session. Not for two threads at once: open one a thread.
class TreeSession {
 public:
  static Expected<TreeSession> open(Document robot);
  /// One to the same robot in which nothing was asked yet.
  TreeSession anew() const;

  /// @param last where the search of a question may begin, see Question; it is kept up to date
  Value answer(const Document& query, std::optional<AnyPose>* last = nullptr,
               Continues continues = Continues::always);

  /// All that is wrong with a question which reading it tells, in the words of its answer; nothing is solved.
  /// Of a question whose answer would be `unsupported` all have the code `not_available`.
  Errors errors_of(const Document& query);

  /// What computes the rows of a question without asking each; empty `make` where there is nothing quicker.
  SamplerKind plan(const RowPlaces& rows);

  /// As Session's.
  void stop_on(StopToken stop);
  void progress_to(ProgressCall call);

  TreeSession(TreeSession&&) noexcept;
  TreeSession& operator=(TreeSession&&) noexcept;
  ~TreeSession();

 private:
  struct State;
  struct Begun;
  explicit TreeSession(std::unique_ptr<State> state);
  Begun begin(const Document& query, Reader& reader, Errors& errors);
  Value put(const Document& query, std::optional<AnyPose>* last, Continues continues, bool is_only_read,
            Errors& errors);

  std::unique_ptr<State> state_;
};

}  // namespace sinew::inline v1
