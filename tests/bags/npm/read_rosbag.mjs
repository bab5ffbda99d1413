// Each message of a rosbag 2.0 as @foxglove/rosbag reads it: topic,seconds,nanoseconds,size.
//
//   node read_rosbag.mjs PACKAGES FILE      (PACKAGES: the folder with node_modules)
import {createRequire} from 'node:module';
import path from 'node:path';

const [packages, file] = process.argv.slice(2);
const load = createRequire(path.join(path.resolve(packages), 'package.json'));
const {Bag} = load('@foxglove/rosbag');
const {FileReader} = load('@foxglove/rosbag/node');
const lz4 = load('@foxglove/wasm-lz4');
const bzip2 = await load('@foxglove/wasm-bz2').init();
await lz4.isLoaded;

const bag = new Bag(new FileReader(file), {
  parse: false,
  decompress: {
    lz4: (bytes, size) => lz4(bytes, size),
    bz2: (bytes, size) => bzip2.decompress(bytes, size, {small: false}),
  },
});
await bag.open();
const lines = [];
for await (const {topic, timestamp, data} of bag.messageIterator()) {
  lines.push(`${topic},${timestamp.sec},${timestamp.nsec},${data.byteLength}\n`);
}
process.stdout.write(lines.join(''));
