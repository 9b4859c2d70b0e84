// On a phone the controls are a sheet that is dragged between three heights.
const least = 120, usual = 406;

export function makeSheet(sheet: HTMLElement, handle: HTMLElement): void {
  const most = () => window.innerHeight - 52 - 56 - 120;
  let height = Math.min(usual, most());
  const set = (to: number) => {
    height = Math.max(least, Math.min(most(), to));
    document.documentElement.style.setProperty('--sheet', `${height}px`);
    handle.setAttribute('aria-valuenow', String(Math.round(height)));
  };
  const settle = () => set([least, usual, most()].reduce((best, at) => (Math.abs(at - height) < Math.abs(best - height) ? at : best)));
  handle.addEventListener('pointerdown', (event) => {
    const begin = event.clientY, before = height;
    handle.setPointerCapture(event.pointerId);
    sheet.classList.add('dragged');
    const move = (moved: PointerEvent) => set(before + begin - moved.clientY);
    handle.addEventListener('pointermove', move);
    handle.addEventListener('lostpointercapture', () => {
      handle.removeEventListener('pointermove', move);
      sheet.classList.remove('dragged');
      settle();
    }, {once: true});
  });
  handle.addEventListener('keydown', (event) => {
    const way = event.key === 'ArrowUp' ? 1 : event.key === 'ArrowDown' ? -1 : 0, stops = [least, usual, most()];
    if (way === 0) return;
    const at = stops.indexOf(height);
    set(stops[Math.max(0, Math.min(2, at + way))]!);
    event.preventDefault();
  });
  window.addEventListener('resize', () => set(height));
  set(height);
}
