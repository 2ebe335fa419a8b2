// Breaks the poisoned-identifiers rule on purpose.
int wide(void);
int wide(void) { return sizeof(double) > 4; }
