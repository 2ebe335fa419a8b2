namespace traction::sim {

namespace {

double radius(double size_m) { return size_m / 2; }

} // namespace

double wheel(double size_m) { return radius(size_m); }

} // namespace traction::sim
