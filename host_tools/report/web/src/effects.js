// effects.js - the small drawings of effects, as the program made them of its catalogue (host_tools/report/effect_drawing.h).
let drawings = {};
export const setDrawings = (all) => { drawings = all ?? {}; };

// The drawing of an effect, anew each time; nothing where there is none. Its text is parsed as XML, never as markup of the page.
export function drawing(name) {
  const text = drawings[name];
  if (!text) return null;
  const { documentElement: root } = new DOMParser().parseFromString(text, 'image/svg+xml');
  return root.nodeName === 'svg' ? document.importNode(root, true) : null;
}
