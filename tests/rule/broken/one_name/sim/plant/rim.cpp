namespace traction::sim {

namespace {

constexpr double rubber_m = 0.01;
struct Edge {
    int at = 0;
};
float radius(float size_m) { return size_m; }

} // namespace

double rim(int size_m) { return radius(static_cast<float>(size_m + Edge{}.at)); }

} // namespace traction::sim
