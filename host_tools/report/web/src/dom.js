// dom.js - makes elements: h('td', { class: 'number' }, '3.1'), s('path', { d }) for SVG. Text is always text, never markup.

function make(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'style') element.style.cssText = value; // the live page's policy forbids the attribute
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  for (const child of children.flat(Infinity)) {
    if (child === undefined || child === null || child === false) continue;
    element.append(child instanceof Node ? child : String(child));
  }
  return element;
}

export const h = (tag, attributes, ...children) => make(document.createElement(tag), attributes, children);
export const s = (tag, attributes, ...children) =>
  make(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);

// A table with a caption, column heads and rows; on a narrow screen each row becomes a card (page.css). A column: { head, number, title }.
// A cell: text, node or array of them.
export function table(caption, columns, rows) {
  const head = columns.map((c) => h('th', { scope: 'col', class: c.number && 'number', title: c.title }, c.head));
  const body = rows.map((row) =>
    h('tr', {}, row.map((cell, i) =>
      i === 0
        ? h('th', { scope: 'row', class: columns[i]?.number && 'number' }, cell)
        : h('td', { class: columns[i]?.number && 'number', 'data-head': columns[i]?.head }, cell))));
  return h('div', { class: 'scroll' },
    h('table', { class: 'stack' }, h('caption', {}, caption), h('thead', {}, h('tr', {}, head)), h('tbody', {}, body)));
}

// What runs over its box can be reached by keys, and what does not is no stop on the way.
export function markScrollers(root) {
  for (const box of root.querySelectorAll('.scroll')) {
    if (box.scrollWidth <= box.clientWidth) {
      for (const name of ['tabindex', 'role', 'aria-label']) box.removeAttribute(name);
      continue;
    }
    box.tabIndex = 0;
    box.setAttribute('role', 'region');
    box.setAttribute('aria-label', box.querySelector('caption')?.textContent ?? 'table');
  }
}
