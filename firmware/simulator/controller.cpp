#include "simulator/controller.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

extern "C" {
#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_spi.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

namespace sinew::firmware {
namespace {

void say_nothing(avr_t*, int, const char*, va_list) {}

/// Cycles of a byte on SPI: eight bits, each as long as SPCR and SPSR divide the clock.
avr_cycle_count_t cycles_of_spi_byte(avr_t* avr, const avr_spi_t& spi) {
  constexpr std::array<unsigned, 4> dividers = {4, 16, 64, 128};
  const unsigned divider = dividers[avr_regbit_get(avr, spi.spr[0]) + 2u * avr_regbit_get(avr, spi.spr[1])];
  return 8 * (avr_regbit_get(avr, spi.spr[2]) ? divider / 2 : divider);
}

avr_cycle_count_t finish_spi_byte(avr_t* avr, avr_cycle_count_t, void* of) {
  auto& spi = *static_cast<avr_spi_t*>(of);
  if (avr_regbit_get(avr, spi.spe) && avr_regbit_get(avr, spi.mstr)) {
    avr_raise_interrupt(avr, &spi.spi);
    avr_raise_irq(spi.io.irq + SPI_IRQ_OUTPUT, avr->data[spi.r_spdr]);
  }
  return 0;
}

/// In the place of the library's own, which takes 100 us for each byte, whatever the clock.
void begin_spi_byte(avr_t* avr, avr_io_addr_t address, std::uint8_t byte, void* of) {
  const auto& spi = *static_cast<const avr_spi_t*>(of);
  avr_regbit_clear(avr, spi.spi.raised);
  avr->data[address] = byte;
  avr_cycle_timer_register(avr, cycles_of_spi_byte(avr, spi), finish_spi_byte, of);
}

constexpr std::uint16_t jump_to_itself = 0xCFFF;  // rjmp .-2
constexpr std::uint32_t framing_error = UART_INPUT_FE;

/// The library reads what it takes for an ELF file without looking.
void expect_elf(const std::filesystem::path& path) {
  std::array<char, 4> head{};
  if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
    const std::size_t read = std::fread(head.data(), 1, head.size(), file);
    std::fclose(file);
    if (read == head.size() && std::memcmp(head.data(), "\177ELF", 4) == 0) return;
    throw std::runtime_error(path.string() + ": not an ELF file");
  }
  throw std::runtime_error(path.string() + ": cannot be read");
}

/// What the library has read, and copied by now.
void release(elf_firmware_t& program) {
  for (std::uint32_t i = 0; i < program.symbolcount; ++i) std::free(program.symbol[i]);
  std::free(program.symbol);
  std::free(program.flash);
  std::free(program.eeprom);
}

}  // namespace

Controller::Controller(const std::filesystem::path& elf, std::uint32_t frequency) : frequency_(frequency) {
  expect_elf(elf);
  avr_global_logger_set(say_nothing);
  elf_firmware_t program{};
  if (elf_read_firmware(elf.c_str(), &program) != 0)
    throw std::runtime_error(elf.string() + ": not a program for an AVR");
  avr_ = avr_make_mcu_by_name("atmega2560");
  if (!avr_) throw std::runtime_error("simavr does not know the atmega2560");
  avr_init(avr_);
  program.frequency = frequency;
  avr_load_firmware(avr_, &program);
  release(program);
  avr_->frequency = frequency;
  avr_->custom.data = this;
  avr_->sleep = [](avr_t* avr, avr_cycle_count_t cycles) {  // in no time
    static_cast<Controller*>(avr->custom.data)->asleep_ += cycles;
  };
  avr_->log = LOG_NONE;
  connect();
}

Controller::~Controller() {
  avr_terminate(avr_);
  std::free(avr_);  // the library allocates it and has no way to give it back
}

void Controller::connect() {
  std::uint32_t flags = 0;  // no copy on stdout, no sleep while polled
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  uart_input_ = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
  const auto on_uart = [](int index, avr_irq_notify_t notify, Controller* self) {
    avr_irq_register_notify(avr_io_getirq(self->avr_, AVR_IOCTL_UART_GETIRQ('0'), index), notify, self);
  };
  on_uart(
      UART_IRQ_OUTPUT,
      [](avr_irq_t*, std::uint32_t byte, void* self) {
        auto& controller = *static_cast<Controller*>(self);
        controller.incoming_.push_back(static_cast<char>(byte));
        if (controller.on_sent) controller.on_sent(static_cast<std::uint8_t>(byte));
      },
      this);
  on_uart(
      UART_IRQ_OUT_XON,
      [](avr_irq_t*, std::uint32_t on, void* self) {
        if (on) static_cast<Controller*>(self)->has_room_ = true;
      },
      this);
  on_uart(
      UART_IRQ_OUT_XOFF,
      [](avr_irq_t*, std::uint32_t off, void* self) {
        if (off) static_cast<Controller*>(self)->has_room_ = false;
      },
      this);
  constexpr std::size_t spi_data = 0x4E;
  avr_->io[AVR_DATA_TO_IO(spi_data)].w.c = begin_spi_byte;
  spi_input_ = avr_io_getirq(avr_, AVR_IOCTL_SPI_GETIRQ(0), SPI_IRQ_INPUT);
  avr_irq_register_notify(
      avr_io_getirq(avr_, AVR_IOCTL_SPI_GETIRQ(0), SPI_IRQ_OUTPUT),
      [](avr_irq_t*, std::uint32_t byte, void* self) {
        auto& controller = *static_cast<Controller*>(self);
        const auto sent = static_cast<std::uint8_t>(byte);
        avr_raise_irq(controller.spi_input_, controller.spi ? controller.spi(sent) : 0xFF);
      },
      this);
}

void Controller::watch_port_b(int bit, std::function<void(bool)> changed) {
  port_b_changed_ = std::move(changed);
  avr_irq_register_notify(
      avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ('B'), bit),
      [](avr_irq_t*, std::uint32_t value, void* self) {
        static_cast<Controller*>(self)->port_b_changed_((value & 1) != 0);
      },
      this);
}

void Controller::feed() {
  constexpr std::size_t control = 0xC1, receiver_enabled = 0x10;  // UCSR0B: else what comes is lost
  if (outgoing_.empty() || (avr_->data[control] & receiver_enabled) == 0) return;
  while (has_room_ && !outgoing_.empty()) {
    const auto byte = static_cast<std::uint8_t>(outgoing_.front());
    outgoing_.pop_front();
    const int arriving = line ? line(byte) : byte;
    avr_raise_irq(uart_input_, arriving < 0 ? framing_error : static_cast<std::uint32_t>(arriving));
  }
}

bool Controller::step() {
  if (avr_->state == cpu_Done || avr_->state == cpu_Crashed) return false;
  feed();
  const int state = avr_run(avr_);
  return state != cpu_Done && state != cpu_Crashed;
}

bool Controller::run(std::uint64_t cycles) {
  // The library looks for other things to do after so many cycles, or when its timers or an interrupt want
  // it.
  constexpr std::uint32_t burst = 160, instruction = 1;
  const std::uint64_t end = cycle() + cycles;
  avr_->run_cycle_limit = burst;
  bool runs = true;
  while (runs && cycle() < end) runs = step();
  avr_->run_cycle_limit = avr_->run_cycle_count = instruction;
  return runs;
}

bool Controller::has_crashed() const { return avr_->state == cpu_Crashed; }

std::uint64_t Controller::cycle() const { return avr_->cycle; }

double Controller::byte_time() const {
  constexpr std::size_t status = 0xC0, rate_low = 0xC4, rate_high = 0xC5, double_speed = 0x02;
  const int divider = 1 + avr_->data[rate_low] + ((avr_->data[rate_high] & 0x0F) << 8);
  return 10.0 * divider * (avr_->data[status] & double_speed ? 8 : 16) / frequency_;
}

bool Controller::is_high(char port, int bit) const {
  // Not by the simulator's signals: these say nothing when a reset lets go of a pin.
  constexpr std::size_t ddr_b = 0x24, port_b = 0x25, ddr_l = 0x10A, port_l = 0x10B;
  const bool b = port == 'B';
  if (!b && port != 'L') throw std::invalid_argument("only ports B and L are wired");
  return ((avr_->data[b ? ddr_b : ddr_l] & avr_->data[b ? port_b : port_l]) >> bit & 1) != 0;
}

std::span<std::uint8_t> Controller::eeprom() {
  avr_eeprom_desc_t all{nullptr, 0, avr_->e2end + 1u};
  avr_ioctl(avr_, AVR_IOCTL_EEPROM_GET, &all);
  return {all.ee, all.size};
}

void Controller::reset() {
  outgoing_.clear();
  has_room_ = true;
  avr_reset(avr_);
}

void Controller::hang() {
  hung_at_ = avr_->pc;
  std::memcpy(&hung_instruction_, avr_->flash + hung_at_, sizeof hung_instruction_);
  std::memcpy(avr_->flash + hung_at_, &jump_to_itself, sizeof jump_to_itself);
  is_hung_ = true;
}

void Controller::mend() {
  if (is_hung_) std::memcpy(avr_->flash + hung_at_, &hung_instruction_, sizeof hung_instruction_);
  is_hung_ = false;
}

}  // namespace sinew::firmware
