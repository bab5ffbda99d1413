// MCAP as @mcap/core reads and writes it.
//
//   node mcap.mjs PACKAGES read FILE                     prints topic,log time (ns),size
//   node mcap.mjs PACKAGES write FILE COMPRESSION COUNT  COMPRESSION: unchunked, none, zstd
//
// A written file has COUNT messages, message i of topic /camera<i % 3>, at 1000 + i ns, 40 + i bytes.
import {createRequire} from 'node:module';
import fs from 'node:fs/promises';
import path from 'node:path';

const [packages, action, file, compression, count] = process.argv.slice(2);
const load = createRequire(path.join(path.resolve(packages), 'package.json'));
const {McapStreamReader, McapWriter} = load('@mcap/core');
const lz4 = load('@foxglove/wasm-lz4');
const zstd = load('@foxglove/wasm-zstd');
await Promise.all([lz4.isLoaded, zstd.isLoaded]);
const decompressHandlers = {
  lz4: (bytes, size) => lz4(bytes, Number(size)),
  zstd: (bytes, size) => zstd.decompress(bytes, Number(size)),
};

async function read() {
  const bytes = await fs.readFile(file);
  const reader = new McapStreamReader({decompressHandlers, validateCrcs: true});
  reader.append(bytes);
  const topics = new Map();
  const lines = [];
  for (let record; (record = reader.nextRecord());) {
    if (record.type === 'Channel') topics.set(record.id, record.topic);
    if (record.type === 'Message') {
      lines.push(`${topics.get(record.channelId)},${record.logTime},${record.data.byteLength}\n`);
    }
  }
  if (!reader.done()) throw new Error('the file does not end');
  process.stdout.write(lines.join(''));
}

async function write() {
  const parts = [];
  let size = 0n;
  const writable = {
    position: () => size,
    write: async (bytes) => {
      parts.push(Buffer.from(bytes));
      size += BigInt(bytes.byteLength);
    },
  };
  const writer = new McapWriter({
    writable,
    useChunks: compression !== 'unchunked',
    chunkSize: 400,
    compressChunk: compression === 'zstd'
      ? (bytes) => ({compression: 'zstd', compressedData: zstd.compress(bytes, 3)})
      : undefined,
  });
  await writer.start({profile: 'ros2', library: 'tests'});
  const schemaId = await writer.registerSchema(
      {name: 'sensor_msgs/msg/Image', encoding: 'ros2msg', data: new Uint8Array()});
  const channels = [];
  for (let i = 0; i < 3; ++i) {
    channels.push(await writer.registerChannel(
        {schemaId, topic: `/camera${i}`, messageEncoding: 'cdr', metadata: new Map()}));
  }
  for (let i = 0; i < Number(count); ++i) {
    await writer.addMessage({
      channelId: channels[i % 3],
      sequence: i,
      logTime: BigInt(1000 + i),
      publishTime: BigInt(1000 + i),
      data: new Uint8Array(40 + i).fill(i),
    });
  }
  await writer.end();
  await fs.writeFile(file, Buffer.concat(parts));
}

await (action === 'read' ? read() : write());
