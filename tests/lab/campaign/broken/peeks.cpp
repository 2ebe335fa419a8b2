const char *peek = "seals/seal_1.json";
