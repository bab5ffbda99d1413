// Reports for the tests, made by the real program.
import {execFileSync} from 'node:child_process';
import {readFileSync, writeFileSync} from 'node:fs';
import path from 'node:path';

const kScenario = '18cam_6host_45fps';
const kPipelines = 'ntp_last_set,yoon2021_both,genlock';

// {one, two, hostile}: files with one archive, with two, and with names that are markup.
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
  const evil = '</script><script>window.broken = 1</script><img src=http://x/ onerror="window.broken=2">';
  const results = JSON.parse(readFileSync(file('monday/results.json'), 'utf8'));
  results.scenario = evil;
  results.warnings = [evil];
  results.rows[0].pipeline = evil;
  writeFileSync(file('hostile.json'), JSON.stringify(results));
  run('report', 'hostile.json', '-o', 'hostile.html');
  return {one: file('one.html'), two: file('two.html'), hostile: file('hostile.html')};
}
