namespace traction::sim {

namespace {

constexpr double tread_m = 0.02, rubber_m = 0.03;
double radius(double size_m) { return size_m / 2; }

} // namespace

double wheel(double size_m) { return radius(size_m); }

} // namespace traction::sim
