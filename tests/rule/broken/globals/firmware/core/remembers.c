// Breaks the no-mutable-globals rule on purpose.
int remembers(void);
static int count;
int remembers(void) { return ++count; }
