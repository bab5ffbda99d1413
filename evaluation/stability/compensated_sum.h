// A sum that keeps what each addition rounds away, so that large terms which cancel leave the small
// ones exact. Source: Ogita, Rump and Oishi 2005, "Accurate sum and dot product", algorithm Sum2.
//
//   CompensatedSum sum;
//   sum.add(1e16);
//   sum.add(1);
//   sum.add(-1e16);
//   const double one = sum.value();
#pragma once

namespace simbench::evaluation {

class CompensatedSum {
 public:
  void add(double term) {
    // The error of one addition, exactly and without a branch (Knuth's two-sum).
    const double sum = sum_ + term;
    const double added = sum - sum_;
    rest_ += (sum_ - (sum - added)) + (term - added);
    sum_ = sum;
  }
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0;
  double rest_ = 0;
};

}  // namespace simbench::evaluation
