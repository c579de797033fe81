// The `keyhole` command.
int main() { return 0; }
