// Checks that are counted: a failed one is printed, and the others go on.
export class Checks {
  passed = 0;
  failed = 0;

  async check(name, action) {
    try {
      await action();
      ++this.passed;
    } catch (error) {
      ++this.failed;
      console.log(`FAILED: ${name}\n  ${String(error.message).replaceAll('\n', '\n  ')}`);
    }
  }

  // Ends the program, with a line of how many passed.
  finish() {
    console.log(`${this.passed} checks passed, ${this.failed} failed`);
    process.exit(this.failed === 0 ? 0 : 1);
  }
}
