// Reports for the tests, made by the real program.
import {execFileSync} from 'node:child_process';
import {readFileSync, writeFileSync} from 'node:fs';
import path from 'node:path';

const kScenario = '18cam_6host_45fps';
const kPipelines = 'ntp_last_set,yoon2021_both,genlock';

// A minute of two cameras of which the second runs free, as `simbench diagnose` reads them.
function recording() {
  const lines = ['Stream Type,Index,F#,HW Timestamp (ms),Host Timestamp(ms),camera,host'];
  for (let i = 0; i < 1800; ++i) {
    const ms = i * 1000 / 30, late = 9 + i * 7919 % 97 * 0.005;
    lines.push(`Depth,0,${i},${(700 + ms).toFixed(3)},${(ms + late).toFixed(6)},left,pc`);
    lines.push(`Depth,0,${i},${(400 + ms).toFixed(3)},${(ms * 1.00006 + late).toFixed(6)},right,pc`);
  }
  return `${lines.join('\n')}\n`;
}

// Half an hour of a clock that wanders, steps once, and was not measured for a minute.
function clockLog() {
  const lines = ['t_s,x_s'];
  for (let i = 0; i < 1800; ++i) {
    const ns = 30 * Math.sin(i / 200) + i * 7919 % 11 + (i < 1200 ? 0 : 400);
    if (i < 600 || i >= 660) lines.push(`${i},${(1e-9 * ns).toExponential(6)}`);
  }
  return `${lines.join('\n')}\n`;
}

// The pages of other commands: {clocks, sweep, diagnose, compare, stability}. The archive `monday` is there.
export function makeOtherPages(simbench, folder) {
  const run = (...words) => execFileSync(simbench, words, {cwd: folder, stdio: 'pipe'});
  const file = (name) => path.join(folder, name);
  run('clocks', '--scenario', '6host_star', '--duration-s', '900', '--seeds', '4', '--output', 'star');
  run('report', 'star', '-o', 'clocks.html');
  run('sweep', '--scenario', '3cam_1host_30fps', '--sweep', '/usb/delivery_jitter_transfers=0:0.4:0.2',
      '--set', '/timeline/frames=120', '--seeds', '4', '--output', 'jitter');
  writeFileSync(file('rig.csv'), recording());
  run('diagnose', 'rig.csv', '--html', 'diagnose.html');
  writeFileSync(file('clock.csv'), clockLog());
  run('stability', 'clock.csv', '--limit', 'max_te=2us', '--html', 'stability.html');
  run('compare', 'monday', '--with-baseline', 'ntp_last_set', '--html', 'compare.html');
  return {
    clocks: file('clocks.html'), sweep: file('jitter/sweep.html'), diagnose: file('diagnose.html'),
    compare: file('compare.html'), stability: file('stability.html'),
  };
}

// {one, two, paired, hostile}: files with one archive, with two, with two of the same seeds, and with
// names that are markup.
export function makeReport(simbench, folder) {
  const run = (...words) => execFileSync(simbench, words, {cwd: folder, stdio: 'pipe'});
  const simulate = (name, ...more) => run(
      'run', '--scenario', kScenario, '--pipelines', kPipelines, '--set', '/timeline/frames=120',
      '--seeds', '3', '--output', name, ...more);
  const file = (name) => path.join(folder, name);

  simulate('monday');
  simulate('tuesday', '--first-seed', '11');
  run('report', 'monday', '-o', 'one.html', '--seeds-in-detail', '2', '--budget-seeds', '1');
  run('report', 'monday', 'tuesday', '-o', 'two.html', '--seeds-in-detail', '1', '--budget-seeds', '0');
  simulate('wednesday', '--set', '/algorithms/yoon2021/stamps=50');
  run('report', 'monday', 'wednesday', '-o', 'paired.html', '--seeds-in-detail', '1', '--budget-seeds', '0');
  const evil = '</script><script>window.broken = 1</script><img src=http://x/ onerror="window.broken=2">';
  const results = JSON.parse(readFileSync(file('monday/results.json'), 'utf8'));
  results.scenario = evil;
  results.warnings = [evil];
  results.rows[0].pipeline = evil;
  writeFileSync(file('hostile.json'), JSON.stringify(results));
  run('report', 'hostile.json', '-o', 'hostile.html');
  return {
    one: file('one.html'), two: file('two.html'), paired: file('paired.html'), hostile: file('hostile.html'),
  };
}
