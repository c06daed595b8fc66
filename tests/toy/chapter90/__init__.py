TITLE = "A toy"
