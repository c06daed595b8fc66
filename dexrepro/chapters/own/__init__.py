"""What belongs to no chapter of the book: a scene that the user describes in a file."""

TITLE = "Your own scene"
