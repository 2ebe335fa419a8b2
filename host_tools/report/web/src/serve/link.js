// link.js - the way to the server: requests with the token of the page's address, events that come by themselves, and what is told when
// the server is gone.
const token = new URLSearchParams(location.search).get('token') ?? '';

// The answer, or an Error whose message is the server's own sentence.
async function ask(path, body) {
  let response;
  try {
    response = await fetch(path, { method: body ? 'POST' : 'GET', headers: { 'X-Traction-Token': token, ...(body && { 'Content-Type': 'application/json' }) },
      body: body && JSON.stringify(body) });
  } catch {
    throw new Error('The server does not answer.');
  }
  const text = await response.text();
  let answer = null;
  try { answer = JSON.parse(text); } catch { /* told below */ }
  if (!response.ok) throw new Error(answer?.error ?? `The server answers with ${response.status}.`);
  return answer;
}

// The code that draws a drive, once, as text that the page runs when a drive is opened; without it the drive is a map.
export async function bringScene() {
  if (document.getElementById('scene')) return;
  const response = await fetch('/api/scene', { headers: { 'X-Traction-Token': token } }).catch(() => null);
  if (!response?.ok) return;
  const code = Object.assign(document.createElement('script'), { type: 'text/plain', id: 'scene', nonce: document.querySelector('script[nonce]').nonce });
  code.textContent = await response.text();
  document.head.append(code);
}

export const get = (path) => ask(path);
export const post = (path, body) => ask(path, body);

// handlers: { state, work, rows, telemetry, link(connected, words) }. Comes back by itself, and then gets everything anew.
export function listen(handlers) {
  let gone = null;
  const open = () => {
    const events = new EventSource(`/events?token=${encodeURIComponent(token)}`);
    events.onopen = () => { gone = null; handlers.link(true, 'Connected'); };
    for (const name of ['state', 'work', 'rows', 'telemetry']) events.addEventListener(name, (e) => handlers[name](JSON.parse(e.data)));
    events.onerror = async () => {
      gone ??= new Date().toLocaleTimeString([], { hour12: false });
      handlers.link(false, `The server has not answered since ${gone}. Start traction serve again with this folder and port; the page comes back by itself.`);
      if (events.readyState !== EventSource.CLOSED) return; // it tries again
      events.close();
      try {
        await get('/api/effects');
      } catch (error) {
        if (!/does not answer/.test(error.message)) handlers.link(false, `The server refuses this page: ${error.message}`);
      }
      setTimeout(open, 2000);
    };
    addEventListener('pagehide', () => events.close(), { once: true });
  };
  open();
}
