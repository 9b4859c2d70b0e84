// The best picture that this browser can draw.
import type {Picture} from './picture';
import {PlainPicture} from './plain_picture';
import {Scene} from './scene';

export function makePicture(box: HTMLElement): Picture {
  try {
    return new Scene(box);
  } catch {
    box.replaceChildren();  // three leaves a canvas
    return new PlainPicture(box);
  }
}
