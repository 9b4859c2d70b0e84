/// @file board.h
/// The ATmega2560 with what is wired to it: what to change for other wiring. The pins stand in
/// firmware/README.md.
#ifndef SINEW_FIRMWARE_BOARD_H
#define SINEW_FIRMWARE_BOARD_H

#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "avr/uart.h"
#include "protocol/arm.h"
#include "protocol/crc16.h"

namespace sinew {
namespace firmware {

/// There is one, and all of it is static: an AVR reaches what has an address of its own in half of the time.
class Board {
 public:
  // Pins of the Arduino Mega 2560: 53 LATCH, 52 SCK, 51 MOSI, 50 MISO on port B, 49 ENABLE on port L.
  // LATCH is the SPI's own SS: as an output it keeps the controller the master.
  static constexpr Uint8 latch = _BV(PB0), clock = _BV(PB1), out = _BV(PB2), enabled = _BV(PL0);

  /// SPI at F_CPU/4: SPR1, SPR0 and SPI2X divide by 4, 16, 64 or 128, doubled by half of that.
  static constexpr Uint8 spi_rate = 0, spi_double = 0;

  /// The pins first: the drives are disabled before anything else runs.
  static void start() {
    PORTL &= static_cast<Uint8>(~enabled);
    DDRL |= enabled;
    PORTB |= latch;
    DDRB |= latch | clock | out;
    SPCR = _BV(SPE) | _BV(MSTR) | spi_rate;  // mode 0, most significant bit first
    SPSR = spi_double;
    start_clock();
    Uart::start();
  }

  static void enable(bool on) { on ? PORTL |= enabled : PORTL &= static_cast<Uint8>(~enabled); }

  /// Four bytes a drive, the most significant first, from section 1 tendon 1 on; where tensions are measured
  /// two for each tendon's; then two of a checksum of these. The rising latch makes the drives take what they
  /// have been sent; what they send is from before.
  static bool exchange(const Counts& setpoints) {
    // An AVR has the least significant byte first.
    const Uint8* out = reinterpret_cast<const Uint8*>(setpoints);
    Uint8* in = answer_;
    Crc16 sent, received;
    // While a byte is on its way, checksums are summed up of it and of the answer to the one before.
    const auto next = [&sent, &received, &in](Uint8 byte) {
      const Uint8 answer = shifted();
      SPDR = byte;
      sent.add(byte);
      received.add(answer);
      *in++ = answer;
    };
    PORTB &= static_cast<Uint8>(~latch);
    SPDR = out[3];
    sent.add(out[3]);
    for (Uint8 i = drive_count;; out += 4) {
      next(out[2]);
      next(out[1]);
      next(out[0]);
      if (--i == 0) break;
      next(out[7]);
    }
    for (Uint8 i = tension_bytes; i > 0; --i) next(0);
    const Uint8 low = sent.low();
    next(sent.high());
    const Uint8 high_answer = shifted();
    SPDR = low;
    const Uint8 low_answer = shifted();
    PORTB |= latch;
    return high_answer == received.high() && low_answer == received.low();
  }
  static Int32 measured(Uint8 drive) {
    Uint32 count = 0;
    for (const Uint8 *byte = answer_ + 4 * drive, *end = byte + 4; byte != end; ++byte)
      count = count << 8 | *byte;
    return static_cast<Int32>(count);
  }

  static Uint16 tension(Uint8 tendon) {
    const Uint8* const bytes = answer_ + 4 * drive_count + 2 * tendon;
    return static_cast<Uint16>(bytes[0] << 8 | bytes[1]);
  }

  static Uint16 milliseconds() {
    cli();  // two bytes
    const Uint16 now = ticks_;
    sei();
    return now;
  }

  static Uint8 eeprom_read(Uint16 address) { return eeprom_read_byte(at(address)); }
  static void eeprom_write(Uint16 address, Uint8 byte) { eeprom_write_byte(at(address), byte); }
  static bool is_eeprom_ready() { return eeprom_is_ready(); }

  static Uint8 room() { return Uart::room(); }
  static void put(Uint8 byte) { Uart::put(byte); }
  static void put(const Uint8* bytes, Uint8 size) {
    for (const Uint8* const end = bytes + size; bytes != end; ++bytes) Uart::put(*bytes);
  }
  /// What goes out is a sign of life: of many drives a reply may take longer than the watchdog waits.
  static void flush() {
    Uart::flush();
    wdt_reset();
  }

  /// Until the next interrupt, unless something has come.
  static void rest() {
    cli();
    if (!Uart::has_received() && !ticked_) {
      sleep_enable();
      sei();
      sleep_cpu();  // the instruction after sei comes before any interrupt
      sleep_disable();
    }
    sei();
  }

  static void on_tick() {
    ++ticks_;
    ticked_ = true;
  }
  /// Whether a millisecond has gone by since this was last asked.
  static bool has_ticked() {
    if (!ticked_) return false;
    ticked_ = false;
    return true;
  }

 private:
  /// A tick of 1 ms.
  static void start_clock() {
    static_assert(F_CPU % 64000 == 0 && F_CPU / 64000 <= 256, "the clock divides into milliseconds");
    TCCR0A = _BV(WGM01);
    OCR0A = F_CPU / 64000 - 1;
    TIMSK0 = _BV(OCIE0A);
    TCCR0B = _BV(CS01) | _BV(CS00);
  }
  static Uint8 shifted() {
    while (!(SPSR & _BV(SPIF))) {
    }
    return SPDR;
  }
  static Uint8* at(Uint16 address) { return reinterpret_cast<Uint8*>(address); }

  static constexpr Uint8 tension_bytes = has_tensions ? 2 * tendon_drives : 0;
  static Uint8 answer_[4 * drive_count + tension_bytes];  ///< of the drives, as it came
  static volatile Uint16 ticks_;
  static volatile bool ticked_;
};
Uint8 Board::answer_[4 * drive_count + Board::tension_bytes] = {};
volatile Uint16 Board::ticks_ = 0;
volatile bool Board::ticked_ = false;

}  // namespace firmware
}  // namespace sinew

#endif
