// node's timers, sockets, threads and children: each line is when something ended, in ms since the
// beginning, and what.
//
//   workers.js serve | workers.js ask ADDRESS
const childProcess = require('child_process');
const dgram = require('dgram');
const fs = require('fs');
const {Worker} = require('worker_threads');

const kPort = 5604;
const begin = process.hrtime.bigint();
const say = (...values) =>
    console.log(Math.round(Number(process.hrtime.bigint() - begin) / 1e6), ...values);
const after = (ms) => new Promise((done) => setTimeout(done, ms));

function serve() {
  const socket = dgram.createSocket('udp4');
  socket.on('message', (data, from) => socket.send(data, from.port, from.address));
  socket.bind(kPort);
}

function echo(address) {
  return new Promise((done) => {
    const socket = dgram.createSocket('udp4');
    socket.on('message', (data) => {
      socket.close();
      done(String(data));
    });
    socket.send('datagram', kPort, address);
  });
}

function fromWorker() {
  const code = `const {parentPort} = require('worker_threads');
      setTimeout(() => parentPort.postMessage('of a worker'), 200);`;
  return new Promise((done) => new Worker(code, {eval: true}).on('message', done));
}

async function ask(address) {
  say(await echo(address));
  await after(250);
  say('timeout');
  let count = 0;
  await new Promise((done) => {
    const every = setInterval(() => {
      if (++count < 3) return;
      clearInterval(every);
      done();
    }, 50);
  });
  say('interval', count);
  say(await fromWorker());
  say(await new Promise((done) =>
    childProcess.exec('sleep 0.3; echo of a child', (_, text) => done(text.trim()))));
  await fs.promises.writeFile('written', 'text');
  say(String(await fs.promises.readFile('written')));
  await after(2 ** 31 - 1);
}

if (process.argv[2] === 'serve') serve();
else ask(process.argv[3]);
