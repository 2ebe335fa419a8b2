// On purpose: the loop's body is the semicolon.
int stops_late(int distance)
{
    int steps = 0;
    while (distance > steps);
    {
        steps++;
    }
    return steps;
}
