/// The firmware of an ATmega2560 between a host on UART0 and servo drives on SPI. Protocol, pins and how to
/// flash it: firmware/README.md
#include "avr/board.h"
#include "protocol/session.h"

namespace {

using sinew::firmware::Uart;

sinew::firmware::Board board;
sinew::firmware::Session<sinew::firmware::Board> session(board);

/// p power, b brown-out, w watchdog, e the reset pin. Read at once, and the watchdog stopped: after it has
/// bitten, it goes on with its shortest time.
char reset_cause() {
  const unsigned char flags = MCUSR;
  MCUSR = 0;
  wdt_disable();
  return flags & _BV(WDRF) ? 'w' : flags & _BV(PORF) ? 'p' : flags & _BV(BORF) ? 'b' : 'e';
}

}  // namespace

ISR(TIMER0_COMPA_vect) { board.on_tick(); }

int main() {
  const char cause = reset_cause();
  board.start();
  session.start(cause);
  wdt_enable(WDTO_120MS);
  sei();
  for (;;) {
    if (board.has_ticked()) {
      wdt_reset();
      session.watch();
    }
    const volatile unsigned char* bytes = nullptr;
    if (const unsigned char size = Uart::received(bytes)) {
      Uart::drop(session.collect(bytes, size));
      session.answer();
    } else {
      board.rest();
    }
  }
}
