// Nothing to find: it is read before twice.cpp, in the same unit.
int sound(int a) { return a + 1; }
