// Numbers beside bars: how much of a limit is left, or how much from zero to either side.

export interface Bar {
  name: string;
  text: string;      ///< value with its unit
  from: number;      ///< of the bar, as a part of the whole, 0 to 1
  to: number;
  state?: 'slack' | 'over';  ///< asks for attention
  title?: string;
}

/** From zero in the middle to a signed value; the largest one fills its side. */
export function signed(name: string, value: number, largest: number, text: string): Bar {
  const part = 0.5 + 0.5 * (largest > 0 ? value / largest : 0);
  return {name, text, from: Math.min(0.5, part), to: Math.max(0.5, part)};
}

/** From nothing to a part of the whole. */
export const filled = (name: string, part: number, text: string, state?: 'slack' | 'over', title?: string): Bar =>
  ({name, text, from: 0, to: Math.min(1, Math.max(0, part)), ...(state && {state}), ...(title && {title})});

export interface Section { title: string; rows: [string, string][]; bars: Bar[] }

function barRow(bar: Bar): HTMLElement {
  const row = document.createElement('div'), name = document.createElement('span'), track = document.createElement('span'),
        fill = document.createElement('span'), text = document.createElement('span');
  row.className = 'bar';
  if (bar.title) row.title = bar.title;
  name.textContent = bar.name;
  track.className = 'track';
  fill.className = `fill ${bar.state ?? ''}`;
  fill.style.left = `${100 * bar.from}%`;
  fill.style.width = `${100 * (bar.to - bar.from)}%`;
  track.ariaHidden = 'true';
  track.append(fill);
  text.className = 'value';
  text.textContent = (bar.state === 'over' ? '⊗ ' : bar.state === 'slack' ? '▼ ' : '') + bar.text;
  row.append(name, track, text);
  return row;
}

export function sectionOf({title, rows, bars}: Section): HTMLElement {
  const section = document.createElement('div'), heading = document.createElement('h3'), list = document.createElement('dl');
  section.className = 'numbers';
  heading.textContent = title;
  for (const [name, value] of rows) {
    const term = document.createElement('dt'), detail = document.createElement('dd');
    term.textContent = name;
    detail.textContent = value;
    list.append(term, detail);
  }
  section.append(heading, ...(rows.length > 0 ? [list] : []), ...bars.map(barRow));
  return section;
}
