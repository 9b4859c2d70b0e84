/// @file server.hpp
/// The server of the viewer: a page, robots under handles, and queries to them over HTTP. Calls and limits:
/// docs/server.md
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"

namespace sinew::server {

/// What long jobs may take.
struct JobLimits {
  int running = 2;                                   ///< at a time
  std::size_t body = std::size_t{16} << 20U;         ///< [bytes] of a request for one
  std::size_t queries = 100'000;                     ///< of a job
  std::size_t result = std::size_t{256} << 20U;      ///< [bytes] of the answers of a job, or of its table
  std::size_t kept = 16;                             ///< finished ones; the oldest go
  std::size_t kept_bytes = std::size_t{256} << 20U;  ///< of them together; the newest stays in any case
  int threads = 0;                                   ///< of a study; 0: half the cores
  double patience = 30;                              ///< [s] that a job goes on while nobody listens
  int streams = 16;                                  ///< listeners at a time; each takes a connection
  double heart_beat = 3;                             ///< [s] of silence after which a listener gets a sign
};

/// What a client may ask of the server before it is told to wait or to ask less.
struct Limits {
  std::size_t body = std::size_t{1} << 20U;      ///< [bytes]
  std::size_t queries = 1000;                    ///< in a request
  std::size_t answers = std::size_t{64} << 20U;  ///< [bytes] to a request; the queries left over get an error
  double query = 10;                             ///< [s] of computing for a query; then it is stopped
  double time = 30;                              ///< [s] of computing for a request; as answers
  double rate = 50'000;                          ///< queries a second, of an address
  int threads = 64;                              ///< connections served at a time
  double reading = 30;                           ///< [s] from a request's first byte to its last
  std::size_t held = std::size_t{256} << 20U;    ///< [bytes] of all bodies and answers that are under way
  int working = 0;                               ///< requests that compute at a time; 0: one a core
  double patience = 10;                          ///< [s] that a request waits for its turn to compute
  std::size_t robots = 64;                       ///< kept; the one longest unused goes
  std::size_t robot_bytes = std::size_t{4} << 20U;  ///< of the texts of all that are kept
  JobLimits jobs = {};
};

/// The hardware that pages may see and move; neither demonstration nor port: none.
struct DeviceChoice {
  bool is_demo = false;  ///< a simulated one
  std::string port;      ///< `/dev/ttyACM0`
  int baud = 1'000'000;
  std::string folder = "sinew-recordings";  ///< where recordings go
  std::string stage_motor;                  ///< `{lead: 2 mm, counts: 4096}`; empty: as the tendons' motor
};

struct Options {
  std::string address = "127.0.0.1";
  int port = 8765;                 ///< 0: any that is free
  std::string robot;               ///< file or name of the robot that the page opens with; empty: none
  std::vector<Member> settings;    ///< what is changed in it, by the paths of its file
  std::string scene;               ///< file of the scene that the plans are of; empty: none
  std::vector<std::string> plans;  ///< files of insertions into it
  DeviceChoice device;
  /// Pages of this machine, such as notebooks, may show the page in a frame of theirs. Not with a token: the
  /// browser keeps its cookie from frames of other sites.
  bool is_framed = false;
  Limits limits;
};

/// Listens from its making on; answers while `run` runs.
class Server {
 public:
  /// Errors: those of the files of robot, scene and plans; `not_built` where there are plans;
  /// those of device::Device::open; `address_in_use`, `bad_address`;
  /// `not_available` of a frame at another address than this machine's own.
  static Expected<Server> open(const Options& options);

  /// What to open in a browser. Of another address than this machine's own with a token that lets in.
  const std::string& url() const;
  /// Until `stop`, which any thread may call.
  void run();
  void stop();
  /// Lets go of the device, if there is one. Before the process ends without `stop`.
  void let_go();

  Server(Server&&) noexcept;
  Server& operator=(Server&&) noexcept;
  ~Server();

 private:
  struct State;
  explicit Server(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sinew::server
