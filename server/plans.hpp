/// @file plans.hpp
/// Plans of insertions that the server shows, under handles. They are read at its start and checked in the
/// background. A program that was built without planning has none: no_plans.cpp.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "reply.hpp"
#include "sinew/base/error.hpp"

namespace sinew::server {

class Plans {
 public:
  /// The handle of a robot file's text.
  using HandleOf = std::function<std::string(const std::string& text)>;

  Plans();
  ~Plans();
  Plans(const Plans&) = delete;
  Plans& operator=(const Plans&) = delete;

  /// Once, at the start; the checks begin. Errors: those of the files; `not_built` without planning.
  /// @param files of plans, all of the one scene
  Expected<void> read(const std::string& scene, const std::vector<std::string>& files);
  Reply list() const;
  /// The scene, the steps, and once it is done the check.
  Reply plan(std::string_view handle, const HandleOf& handle_of) const;
  /// The solids of the scene, binary: docs/server.md
  Reply meshes(std::string_view handle) const;
  /// A check that runs is to end.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sinew::server
