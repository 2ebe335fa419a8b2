// A file that breaks the rule of format: one space, and a brace on a line of its own.
int crooked( int x )
{
 return x ;
}
