// What the page asks its server for: the other end of explore/explorer.h.

// A request that was answered with a refusal: {message, pointer}.
class Refused extends Error {
  constructor({message, pointer}) {
    super(message);
    this.pointer = pointer;
  }
}

// A state as the server takes it.
function sentState({scenario, sets, pipelines, first_seed}) {
  const changes = Object.entries(sets).map(([pointer, value]) => ({pointer, value}));
  return {scenario, sets: changes, pipelines, first_seed};
}

async function* linesOf(body) {
  const reader = body.pipeThrough(new TextDecoderStream()).getReader();
  let rest = '';
  for (;;) {
    const {value, done} = await reader.read();
    if (done) return;
    const lines = (rest + value).split('\n');
    rest = lines.pop();
    yield* lines;
  }
}

class Server {
  async subject() {
    return (await fetch('subject')).json();
  }

  async post(path, body, signal) {
    const response = await fetch(path, {
      method: 'POST', signal, body: JSON.stringify(body),
      headers: {'Content-Type': 'application/json'},
    });
    if (response.status === 422) throw new Refused(await response.json());
    if (!response.ok) throw new Error(await response.text());
    return response;
  }

  async parameters(state) {
    return (await this.post('parameters', {state: sentState(state)})).json();
  }

  // Text that does the same without the page.
  async text(path, state, seeds) {
    return (await this.post(path, {state: sentState(state), seeds})).text();
  }

  async results(state, seeds, format) {
    const look = {states: [sentState(state)], seeds, format, levers: false};
    return (await this.post('look', look)).text();
  }

  // Calls onEvent with each event. `signal` ends it, and with it what the server computes.
  async look(states, view, onEvent, signal) {
    const response = await this.post('look', {states: states.map(sentState), ...view}, signal);
    for await (const line of linesOf(response.body)) {
      if (signal.aborted) return;
      if (line) onEvent(JSON.parse(line));
    }
  }
}
