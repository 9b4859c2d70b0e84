/// The plans of a server that was built without planning: none.
#include "plans.hpp"

namespace sinew::server {

struct Plans::State {};

Plans::Plans() = default;
Plans::~Plans() = default;

Expected<void> Plans::read(const std::string&, const std::vector<std::string>& files) {
  if (files.empty()) return {};
  return failure("not_built", "--plan",
                 "this sinew was built without planning: install FCL and assimp (Debian's libfcl-dev and "
                 "libassimp-dev) and build it again");
}

Reply Plans::list() const { return {200, R"({"plans":[],"is_built":false})"}; }

Reply Plans::plan(std::string_view, const HandleOf&) const {
  return refused(404, "not_built", "plan", "this sinew was built without planning");
}

Reply Plans::meshes(std::string_view) const {
  return refused(404, "not_built", "plan", "this sinew was built without planning");
}

void Plans::stop() {}

}  // namespace sinew::server
