// What a browser draws 3-D with.

/** Nothing, a graphics card, or the processor, which smooth edges and many pixels cost most of its time. */
export function webgl(): 'none' | 'card' | 'software' {
  const probe = document.createElement('canvas').getContext('webgl2');
  if (!probe) return 'none';
  const info = probe.getExtension('WEBGL_debug_renderer_info'), name = info ? String(probe.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  probe.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name) ? 'software' : 'card';
}
