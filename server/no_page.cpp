#include "assets.hpp"

#include <array>

namespace sinew::server {

std::span<const Asset> assets() {
  static constexpr std::array page{Asset{"/",
                                         "text/html; charset=utf-8",
                                         "<!doctype html>\n<title>sinew</title>\n<h1>sinew</h1>\n"
                                         "<p>This program answers queries here, but was built without its "
                                         "viewer. To get it: <code>./run.sh serve</code>, or configure with "
                                         "<code>-D SINEW_WEB=ON</code> (Node 18 and npm).</p>\n",
                                         {}}};
  return page;
}

}  // namespace sinew::server
