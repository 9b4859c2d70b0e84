/// serve: the viewer in a browser, and queries over HTTP.
#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <thread>

#include "request.hpp"
#include "server/assets.hpp"
#include "server/server.hpp"
#include "terminal.hpp"
#include "verbs.hpp"

namespace sinew::cli {
namespace {

Expected<int> read_port(const std::string& text) {
  if (text.starts_with("/"))
    return failure("out_of_range", "--port",
                   fmt::format("{} is a device, not a port of the network: write --device {}", text, text));
  int port = -1;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, port);
  if (read.ec != std::errc() || read.ptr != end || port < 0 || port > 65535)
    return failure(
        "out_of_range", "--port",
        fmt::format("{} is no port: write a number from 1 to 65535, or 0 for any that is free", text));
  return port;
}

Expected<server::DeviceChoice> read_device(const Arguments& arguments) {
  server::DeviceChoice device;
  device.is_demo = arguments.has("demo");
  if (const std::string* port = arguments.text("device")) device.port = *port;
  if (device.is_demo && !device.port.empty())
    return failure("ambiguous", "--demo", "--demo has a simulated device of its own; leave --device out");
  const bool has_device = device.is_demo || !device.port.empty();
  for (const char* option : {"baud", "stage-motor"})
    if (arguments.has(option) && !has_device)
      return failure("no_effect", fmt::format("--{}", option),
                     "it is of a device: add --device PATH or --demo");
  if (const std::string* folder = arguments.text("record")) device.folder = *folder;
  if (const std::string* motor = arguments.text("stage-motor")) device.stage_motor = *motor;
  if (const std::string* text = arguments.text("baud")) {
    const char* end = text->data() + text->size();
    const auto read = std::from_chars(text->data(), end, device.baud);
    if (read.ec != std::errc() || read.ptr != end || device.baud < 1200)
      return failure(
          "out_of_range", "--baud",
          fmt::format("{} is no rate: write bits a second, as the firmware has it, such as 1000000", *text));
  }
  return device;
}

Expected<server::Options> read_options(const Arguments& arguments) {
  server::Options options;
  options.robot = arguments.operand();
  auto changes = settings(arguments);
  if (!changes) return tl::unexpected(changes.error());
  if (!changes->empty() && options.robot.empty())
    return failure("missing_robot", "--set",
                   "it changes the robot that the page opens with; name one: sinew serve 3-rfr --set "
                   "\"legs[0].link.length=180 mm\"");
  options.settings = std::move(*changes);
  if (const std::string* address = arguments.text("host")) options.address = *address;
  if (const std::string* text = arguments.text("port")) {
    const auto port = read_port(*text);
    if (!port) return tl::unexpected(port.error());
    options.port = *port;
  }
  options.is_framed = arguments.has("frame");
  const auto device = read_device(arguments);
  if (!device) return tl::unexpected(device.error());
  options.device = *device;
  if (arguments.has("scene") != arguments.has("plan"))
    return failure(arguments.has("scene") ? "missing_plan" : "missing_scene", "",
                   "a plan is shown in its scene: give both, --scene SCENE --plan FILE");
  if (const std::string* scene = arguments.text("scene")) options.scene = *scene;
  if (const auto plans = arguments.options.find("plan"); plans != arguments.options.end())
    options.plans = plans->second;
  return options;
}

}  // namespace

int run_serve(const Arguments& arguments) {
  const auto options = read_options(arguments);
  if (!options) return refuse(arguments.verb, options.error());
  auto server = server::Server::open(*options);
  if (!server) return refuse(arguments.verb, server.error());
  finish_what_is_begun();
  print(server->url() + '\n');
  if (!arguments.has("quiet")) {
    if (server->url().find("token") != std::string::npos)
      message("Whoever has this address can ask this machine to compute. It is not encrypted.");
    if (server::assets().size() == 1)
      message(
          "Built without the page; to get it: ./run.sh serve, or configure with -D SINEW_WEB=ON (Node 18 and "
          "npm).");
    if (options->device.is_demo)
      message("The device is simulated, with the firmware's motor where the robot names none.");
    message("Ctrl-C ends it.");
  }
  std::jthread watch([&server](const std::stop_token& over) {
    using namespace std::chrono_literals;
    while (!interrupted() && !over.stop_requested()) std::this_thread::sleep_for(20ms);
    if (!interrupted()) return;
    server->let_go();
    _exit(solved);  // only sockets are open: idle ones would be waited for
  });
  server->run();  // until the socket fails
  return internal_error;
}

}  // namespace sinew::cli
