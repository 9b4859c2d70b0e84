/// Ports: bytes as they are, and what is unplugged is noticed.
#include "server/device/wire/port.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "server/device/wire/link.hpp"

namespace sinew::server::device {
namespace device_port_test {

/// The controller's end of a pseudo-terminal.
struct Pty {
  Pty() : master(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    grantpt(master);
    unlockpt(master);
    std::array<char, 128> text{};
    ptsname_r(master, text.data(), text.size());
    name = text.data();
  }
  ~Pty() { unplug(); }
  void unplug() {
    if (master >= 0) close(master);
    master = -1;
  }
  std::string read() const {
    std::array<char, 4096> bytes{};
    const ssize_t count = ::read(master, bytes.data(), bytes.size());
    return count > 0 ? std::string(bytes.data(), static_cast<std::size_t>(count)) : "";
  }
  /// So many bytes, which the system may hand on one after the other; fewer where they do not come.
  std::string read(std::size_t count) const {
    std::string all;
    pollfd ready{master, POLLIN, 0};
    while (all.size() < count && poll(&ready, 1, 2000) > 0) all += read();
    return all;
  }
  void write(std::string_view bytes) const {
    EXPECT_EQ(::write(master, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  int master;
  std::string name;
};

TEST(DevicePort, CarriesEveryByteAsItIs) {
  Pty pty;
  auto port = open_port(pty.name, 1'000'000).value();
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  port->write(all);
  EXPECT_EQ(pty.read(all.size()), all);
  pty.write(all);
  std::string there;
  for (int k = 0; k < 20 && there.size() < all.size(); ++k) {
    port->wait(0.1);
    there += port->read();
  }
  EXPECT_EQ(there, all);
  EXPECT_EQ(port->read(), "");
  EXPECT_FALSE(port->is_gone());
}

TEST(DevicePort, NoticesThatItIsUnplugged) {
  Pty pty;
  auto port = open_port(pty.name, 115'200).value();
  pty.unplug();
  EXPECT_EQ(port->read(), "");
  EXPECT_TRUE(port->is_gone());
  port->write("x");  // and nothing breaks
}

TEST(DevicePort, SaysWhatIsWrongWithAPath) {
  EXPECT_EQ(open_port("/dev/no-such-device", 9600).error()[0].code, "no_device");
  EXPECT_EQ(open_port("/dev/null", 9600).error()[0].code, "no_device");
  Pty pty;
  const auto first = open_port(pty.name, 9600).value();
  EXPECT_EQ(open_port(pty.name, 9600).error()[0].code, "in_use");
}

TEST(DevicePort, TheLinkOpensItAgainAndSaysHello) {
  auto pty = std::make_unique<Pty>();
  ControllerLink link([&]() -> std::unique_ptr<Wire> {
    if (!pty) return nullptr;
    auto port = open_port(pty->name, 9600);
    return port ? std::move(*port) : nullptr;
  });
  EXPECT_TRUE(link.poll(0).empty());
  std::string hello = encode('H', 0, 0);
  EXPECT_EQ(pty->read(1 + hello.size()), "\n" + hello);
  pty->write("!0 2 disarmed truncated*00000000\n");  // to the line end; before a hello anything may come
  EXPECT_TRUE(link.poll(0.01).empty());
  EXPECT_EQ(link.figures().errors, 0);
  pty.reset();
  const auto events = link.poll(0.02);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, LinkEvent::Kind::gone);
  EXPECT_FALSE(link.is_free());
  pty = std::make_unique<Pty>();
  EXPECT_TRUE(link.poll(0.1).empty());
  EXPECT_EQ(pty->read(), "") << "too early";
  link.poll(0.6);
  EXPECT_EQ(pty->read(1 + hello.size()), "\n" + hello);
}

}  // namespace device_port_test
}  // namespace sinew::server::device
