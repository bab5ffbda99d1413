// A page without a server: what it shows was computed before (explore/demo.h), and is found here by
// the steps of the parameters. The interface is that of server.js, as far as it can be.

async function inflatedText(base64) {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).text();
}

function sameValue(a, b) {
  return JSON.stringify(a) === JSON.stringify(b);
}

class Stored {
  constructor(text) {
    this.loading = inflatedText(text).then(JSON.parse);
  }

  async subject() {
    this.all = await this.loading;
    for (const parameter of this.all.parameters) {
      if (!parameter.steps.some((step) => sameValue(step, parameter.value))) {
        [parameter.value] = parameter.steps;
      }
    }
    return {pipelines: [], first_seed: 1, measured: null, scenarios: [], figures: [],
            first_seeds: this.all.seeds, most_seeds: this.all.seeds, ...this.all.subject};
  }

  async parameters() {
    return {parameters: this.all.parameters, choices: {pipelines: [], stages: []}};
  }

  keyOf({sets}) {
    return this.all.parameters.map(({pointer, value, steps}) => {
      const wanted = pointer in sets ? sets[pointer] : value;
      return Math.max(0, steps.findIndex((step) => sameValue(step, wanted)));
    }).join(',');
  }

  async text(path, {scenario, sets}) {
    const changes = this.all.parameters.map(({pointer, value}) => `--set ${pointer}=${
        valueText(pointer in sets ? sets[pointer] : value)}`);
    return `simbench run --scenario ${scenario} ${changes.join(' ')} --seeds ${this.all.seeds}\n`;
  }

  async look(states, view, onEvent) {
    states.forEach((state, i) => {
      for (const event of this.all.worlds[this.keyOf(state)]) {
        if (event.event === 'worlds') onEvent({...event, state: i});
        if (event.event === 'picture') onEvent({...event, state: i, elapsed_ms: 0});
        if (event.event === 'figures') onEvent({...event, state: i});
      }
    });
    onEvent({event: 'end', seeds: this.all.seeds, why: ''});
  }
}
