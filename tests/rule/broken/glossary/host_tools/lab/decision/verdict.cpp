// A verdict that the glossary does not know.
void judge(bool good) { const char *verdict = good ? "named" : "splendid"; }
