// Where on a slider a value stands, and which value a place has.
//
// A narrow range is linear. A wide one is logarithmic, around the value that the scenario has: two
// decades to either side, within what is allowed, with zero at the left end where it is allowed.
// Where both signs are, both have such a half. A number that is typed may lie beyond the ends.

const kSliderSteps = 1000;
const kDecades = 2;
const kWide = 1000;  // the ratio of a range's ends from which it is logarithmic

function roundedTo(value, digits) {
  return value === 0 ? 0 : Number(value.toPrecision(digits));
}

class SliderScale {
  // `low` and `high` may be undefined: nothing limits the value.
  constructor({low = -Infinity, high = Infinity, value = 0, integer = false}) {
    this.integer = integer;
    const size = Math.abs(value) || (integer ? 10 : 1);
    const smallest = integer ? 1 : size / 10 ** kDecades;
    this.isWide = !Number.isFinite(high - low) || (high - low) / Math.max(smallest, Math.abs(low)) > kWide;
    if (!this.isWide) {
      [this.low, this.high] = [low, high];
      return;
    }
    this.least = Math.max(smallest, low > 0 ? low : 0);
    this.most = Math.max(Math.min(size * 10 ** kDecades, Math.max(high, this.least)), this.least * 10);
    this.isSigned = low < 0 && (value < 0 || low <= -this.most);
    this.hasZero = low <= 0;
  }

  // 0 to 1, of values that are not negative.
  halfAt(value) {
    if (value < this.least) return 0;
    const place = Math.log(value / this.least) / Math.log(this.most / this.least);
    return Math.min(1, this.hasZero ? 0.02 + 0.98 * place : place);
  }

  halfValue(place) {
    if (this.hasZero && place < 0.02) return 0;
    const share = this.hasZero ? (place - 0.02) / 0.98 : place;
    return this.least * (this.most / this.least) ** share;
  }

  placeOf(value) {
    if (!this.isWide) {
      const share = this.high > this.low ? (value - this.low) / (this.high - this.low) : 0;
      return Math.round(kSliderSteps * Math.min(1, Math.max(0, share)));
    }
    if (!this.isSigned) return Math.round(kSliderSteps * this.halfAt(Math.max(value, 0)));
    const half = this.halfAt(Math.abs(value));
    return Math.round(kSliderSteps * (0.5 + Math.sign(value) * half / 2));
  }

  valueAt(place) {
    const share = place / kSliderSteps;
    const value = !this.isWide ? this.low + share * (this.high - this.low) :
        !this.isSigned ? this.halfValue(share) :
        Math.sign(share - 0.5) * this.halfValue(Math.abs(share - 0.5) * 2);
    return this.integer ? Math.round(value) : roundedTo(value, 3);
  }
}

// A slider over given values alone.
class StepScale {
  constructor(steps) {
    this.steps = steps;
  }
  placeOf(value) {
    return Math.max(0, this.steps.findIndex((step) => JSON.stringify(step) === JSON.stringify(value)));
  }
  valueAt(place) {
    return this.steps[place];
  }
}
