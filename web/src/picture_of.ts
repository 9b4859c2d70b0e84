// The best picture that this browser can draw.
import type {Picture} from './picture';
import {PlainPicture} from './plain_picture';
import {Scene} from './scene';
import {webgl} from './webgl';

export const makePicture = (box: HTMLElement): Picture => (webgl() === 'none' ? new PlainPicture(box) : new Scene(box));
