// A comment that breaks the rule: by STUDY.md, see PAPER section 3; docs/tells.md is there.
int wheel;
