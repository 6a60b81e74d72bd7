// name: bags
// kind: table
// description: Which bags were loaded, which kinds of data can be in them, and what does nobody know of them?
// param kind: category, only bags in which data of this kind can be, by labels, types or since nobody knows, default ""
// returns bag: string, where it is
// returns robot: string, the robot that was recorded, as it was named
// returns verdict: string, personal-data, undetermined or nothing-found
// returns kinds: list of string, kinds that can be in it, as labels and policies say
// returns suggested: list of string, kinds that types suggest, with the confidence
// returns open_topics: list of string, topics of which nobody can say what is in them
// returns not_known: list of string, why topics may be missing, and what is in it beside messages
// returns channels: list of string, channels of the robot that were recorded
// order: bag
WITH COLLECT { MATCH (:DataCategory {name: $kind})<-[:BROADER]-*(n) MATCH (n)-[:BROADER]->*(c)
               RETURN DISTINCT c.name AS name } AS may_be
MATCH (b:Bag)
WHERE $kind = '' OR any(one IN b.kinds WHERE one IN may_be)
   OR any(one IN b.suggested WHERE split(one, ' ')[0] IN may_be)
   OR size(b.open_topics) + size(b.gaps) + size(b.beside) > 0
RETURN b.id AS bag, coalesce(b.robot, '') AS robot, b.verdict AS verdict, b.kinds AS kinds, b.suggested AS suggested,
       b.open_topics AS open_topics, b.gaps + b.beside AS not_known,
       COLLECT { MATCH (b)-[:HAS_TOPIC]->(:RecordedTopic)-[:RECORDS]->(c:Element)
                 RETURN DISTINCT c.name AS name ORDER BY name } AS channels
ORDER BY bag
