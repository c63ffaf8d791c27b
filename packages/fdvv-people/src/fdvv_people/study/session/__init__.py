"""A participant's session, from enrolment to the last answer."""
